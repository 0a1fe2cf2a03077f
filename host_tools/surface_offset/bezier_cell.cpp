// Evaluation by Bernstein polynomials, halving by de Casteljau, bounds by convex hulls.
#include "host_tools/surface_offset/bezier_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "host_tools/surface_offset/enclosure.hpp"

namespace cusp::host {
namespace {

constexpr std::size_t kMostControls = 32;
using Row = std::array<double, kMostControls>;

// Bernstein polynomials with first and second derivatives.
struct Basis {
    Row value;
    Row first;
    Row second;
};

void raise_degree(Row& row, std::size_t degree, double s)
{
    double carried = 0;
    for (std::size_t i = 0; i < degree; ++i) {
        const double b = row[i];
        row[i] = carried + (1 - s) * b;
        carried = s * b;
    }
    row[degree] = carried;
}

void differences(const Row& lower, std::size_t degree, Row& out)
{
    const double p = static_cast<double>(degree);
    out[0] = -p * lower[0];
    for (std::size_t i = 1; i < degree; ++i) {
        out[i] = p * (lower[i - 1] - lower[i]);
    }
    out[degree] = p * lower[degree - 1];
}

void bernstein(std::size_t degree, double s, Basis& out)
{
    Row row;
    row[0] = 1;
    for (std::size_t k = 1; k + 1 < degree; ++k) {
        raise_degree(row, k, s);
    }
    if (degree >= 2) {
        Row slope;
        differences(row, degree - 1, slope);
        differences(slope, degree, out.second);
        raise_degree(row, degree - 1, s);
    } else {
        out.second[0] = out.second[1] = 0;
    }
    differences(row, degree, out.first);
    raise_degree(row, degree, s);
    std::copy_n(row.begin(), degree + 1, out.value.begin());
}

// The same with the degree known to the compiler, which leaves no loop.
template <std::size_t Count>
struct FixedBasis {
    std::array<double, Count> value;
    std::array<double, Count> first;
    std::array<double, Count> second;
};

FixedBasis<2> fixed_basis(std::integral_constant<std::size_t, 2>, double s)
{
    return {{1 - s, s}, {-1, 1}, {0, 0}};
}

FixedBasis<4> fixed_basis(std::integral_constant<std::size_t, 4>, double s)
{
    const double r = 1 - s;
    return {{r * r * r, 3 * r * r * s, 3 * r * s * s, s * s * s},
            {-3 * r * r, 3 * r * (r - 2 * s), 3 * s * (2 * r - s), 3 * s * s},
            {6 * r, 6 * (s - 2 * r), 6 * (r - 2 * s), 6 * s}};
}

// Sum over j of the vectors in `row`, times the factors.
template <std::size_t Count>
Vec3d weighted(const std::array<double, 3 * Count>& row, const std::array<double, Count>& factor)
{
    Vec3d sum;
    for (std::size_t j = 0; j < Count; ++j) {
        sum.x += row[3 * j] * factor[j];
        sum.y += row[3 * j + 1] * factor[j];
        sum.z += row[3 * j + 2] * factor[j];
    }
    return sum;
}

// Rows are summed as plain numbers, so that the compiler takes several at once.
template <std::size_t CountS, std::size_t CountT>
SurfacePoint polynomial_at(const Vec3d* points, double s, double t)
{
    static_assert(sizeof(Vec3d) == 3 * sizeof(double));
    const auto bs = fixed_basis(std::integral_constant<std::size_t, CountS>{}, s);
    const auto bt = fixed_basis(std::integral_constant<std::size_t, CountT>{}, t);
    std::array<double, 3 * CountT> value;
    std::array<double, 3 * CountT> first;
    std::array<double, 3 * CountT> second;
    const double* control = &points->x;
    for (std::size_t k = 0; k < 3 * CountT; ++k) {
        double sum = 0;
        double sum_first = 0;
        double sum_second = 0;
        for (std::size_t i = 0; i < CountS; ++i) {
            const double c = control[i * 3 * CountT + k];
            sum += c * bs.value[i];
            sum_first += c * bs.first[i];
            sum_second += c * bs.second[i];
        }
        value[k] = sum;
        first[k] = sum_first;
        second[k] = sum_second;
    }
    return {weighted<CountT>(value, bt.value), weighted<CountT>(first, bt.value),
            weighted<CountT>(value, bt.first), weighted<CountT>(second, bt.value),
            weighted<CountT>(first, bt.first), weighted<CountT>(value, bt.second)};
}

// At one s, as a curve of t: its control points, and those of its derivative by s.
template <std::size_t CountS, std::size_t CountT>
void reduce_to_curve(const Vec3d* points, double s, double* value, double* first)
{
    const auto bs = fixed_basis(std::integral_constant<std::size_t, CountS>{}, s);
    const double* control = &points->x;
    for (std::size_t k = 0; k < 3 * CountT; ++k) {
        double sum = 0;
        double sum_first = 0;
        for (std::size_t i = 0; i < CountS; ++i) {
            const double c = control[i * 3 * CountT + k];
            sum += c * bs.value[i];
            sum_first += c * bs.first[i];
        }
        value[k] = sum;
        first[k] = sum_first;
    }
}

template <std::size_t CountS, std::size_t CountT>
SurfacePoint tangents(const Vec3d* points, double s, double t)
{
    const auto bt = fixed_basis(std::integral_constant<std::size_t, CountT>{}, t);
    std::array<double, 3 * CountT> value;
    std::array<double, 3 * CountT> first;
    reduce_to_curve<CountS, CountT>(points, s, value.data(), first.data());
    return {weighted<CountT>(value, bt.value),
            weighted<CountT>(first, bt.value),
            weighted<CountT>(value, bt.first),
            {},
            {},
            {}};
}

// A box of vectors, with the little arithmetic that quotients need.
struct Box {
    std::array<Enclosure, 3> side{{{0, 0}, {0, 0}, {0, 0}}};
};

Box minus_product(const Box& a, const Box& b, Enclosure k)
{
    Box out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.side[axis] = a.side[axis] - b.side[axis] * k;
    }
    return out;
}

Box quotient(const Box& a, Enclosure k)
{
    Box out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.side[axis] = a.side[axis] / k;
    }
    return out;
}

double farthest(const Box& box, Vec3d from)
{
    double square = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const double reach = std::max(std::abs(box.side[axis].low - from[axis]),
                                      std::abs(box.side[axis].high - from[axis]));
        square += reach * reach;
    }
    return std::sqrt(square);
}

// A net of numbers or vectors, and the nets of its derivatives.
template <class T>
struct Net {
    std::size_t count_s;
    std::size_t count_t;
    std::vector<T> values;

    Net along_s() const
    {
        if (count_s == 1) {
            return {1, count_t, std::vector<T>(count_t, T{})};
        }
        Net out{count_s - 1, count_t, {}};
        const double p = static_cast<double>(count_s - 1);
        for (std::size_t i = 0; i + 1 < count_s; ++i) {
            for (std::size_t j = 0; j < count_t; ++j) {
                out.values.push_back((values[(i + 1) * count_t + j] - values[i * count_t + j]) * p);
            }
        }
        return out;
    }
    Net along_t() const
    {
        if (count_t == 1) {
            return {count_s, 1, std::vector<T>(count_s, T{})};
        }
        Net out{count_s, count_t - 1, {}};
        const double p = static_cast<double>(count_t - 1);
        for (std::size_t i = 0; i < count_s; ++i) {
            for (std::size_t j = 0; j + 1 < count_t; ++j) {
                out.values.push_back((values[i * count_t + j + 1] - values[i * count_t + j]) * p);
            }
        }
        return out;
    }
};

Enclosure range(const Net<double>& net)
{
    const auto [low, high] = std::minmax_element(net.values.begin(), net.values.end());
    return {*low, *high};
}

Box range(const Net<Vec3d>& net)
{
    Box box;
    for (unsigned axis = 0; axis < 3; ++axis) {
        Enclosure side{std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity()};
        for (const Vec3d& value : net.values) {
            side = {std::min(side.low, value[axis]), std::max(side.high, value[axis])};
        }
        box.side[axis] = side;
    }
    return box;
}

// De Casteljau at the middle over `count` values `stride` apart.
template <class T>
void halve(const T* from, T* lower, T* upper, std::size_t count, std::size_t stride)
{
    std::array<T, kMostControls> work;
    for (std::size_t i = 0; i < count; ++i) {
        work[i] = from[i * stride];
    }
    for (std::size_t k = 0; k < count; ++k) {
        lower[k * stride] = work[0];
        upper[(count - 1 - k) * stride] = work[count - 1 - k];
        for (std::size_t i = 0; i + 1 < count - k; ++i) {
            work[i] = (work[i] + work[i + 1]) * 0.5;
        }
    }
}

}  // namespace

BezierCell::BezierCell(const BezierPatch& patch, int surface)
    : surface_{surface},
      count_s_{static_cast<std::size_t>(patch.surface.size_u)},
      count_t_{static_cast<std::size_t>(patch.surface.size_v)},
      points_{patch.surface.points},
      u_begin_{patch.u_begin},
      u_end_{patch.u_end},
      v_begin_{patch.v_begin},
      v_end_{patch.v_end}
{
    const std::vector<double>& weights = patch.surface.weights;
    const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
    if (*least != *most) {
        weights_ = weights;
        for (std::size_t k = 0; k < points_.size(); ++k) {
            points_[k] = points_[k] * weights_[k];
        }
    }
    find_bounds();
}

Vec3d BezierCell::control(std::size_t i, std::size_t j) const
{
    const std::size_t k = i * count_t_ + j;
    return weights_.empty() ? points_[k] : points_[k] / weights_[k];
}

SurfacePoint BezierCell::at(double s, double t) const
{
    if (weights_.empty() && count_s_ == 4 && count_t_ == 4) {
        return polynomial_at<4, 4>(points_.data(), s, t);
    }
    if (weights_.empty() && count_s_ == 2 && count_t_ == 2) {
        return polynomial_at<2, 2>(points_.data(), s, t);
    }
    return at_any_degree(s, t);
}

SurfacePoint BezierCell::tangents_at(double s, double t) const
{
    if (weights_.empty() && count_s_ == 4 && count_t_ == 4) {
        return tangents<4, 4>(points_.data(), s, t);
    }
    return at(s, t);
}

bool BezierCell::cut_at(double s, Curve4& out) const
{
    if (!weights_.empty() || count_s_ != 4 || count_t_ != 4) {
        return false;
    }
    reduce_to_curve<4, 4>(points_.data(), s, out.value.data(), out.along_s.data());
    return true;
}

SurfacePoint BezierCell::on_cut(const Curve4& cut, double t)
{
    const auto bt = fixed_basis(std::integral_constant<std::size_t, 4>{}, t);
    return {weighted<4>(cut.value, bt.value),
            weighted<4>(cut.along_s, bt.value),
            weighted<4>(cut.value, bt.first),
            {},
            {},
            {}};
}

// Of the degree count_s - 1 by count_t - 1.
SurfacePoint BezierCell::at_any_degree(double s, double t) const
{
    Basis bs;
    Basis bt;
    bernstein(count_s_ - 1, s, bs);
    bernstein(count_t_ - 1, t, bt);
    SurfacePoint out;
    double w = 0;
    double ws = 0;
    double wt = 0;
    double wss = 0;
    double wst = 0;
    double wtt = 0;
    for (std::size_t i = 0; i < count_s_; ++i) {
        Vec3d p;
        Vec3d pt;
        Vec3d ptt;
        const Vec3d* row = &points_[i * count_t_];
        for (std::size_t j = 0; j < count_t_; ++j) {
            p = p + row[j] * bt.value[j];
            pt = pt + row[j] * bt.first[j];
            ptt = ptt + row[j] * bt.second[j];
        }
        out.point = out.point + p * bs.value[i];
        out.du = out.du + p * bs.first[i];
        out.duu = out.duu + p * bs.second[i];
        out.dv = out.dv + pt * bs.value[i];
        out.duv = out.duv + pt * bs.first[i];
        out.dvv = out.dvv + ptt * bs.value[i];
        for (std::size_t j = 0; j < (weights_.empty() ? 0 : count_t_); ++j) {
            const double weight = weights_[i * count_t_ + j];
            w += weight * bt.value[j] * bs.value[i];
            ws += weight * bt.value[j] * bs.first[i];
            wss += weight * bt.value[j] * bs.second[i];
            wt += weight * bt.first[j] * bs.value[i];
            wst += weight * bt.first[j] * bs.first[i];
            wtt += weight * bt.second[j] * bs.value[i];
        }
    }
    if (!weights_.empty()) {
        out.point = out.point / w;
        out.du = (out.du - out.point * ws) / w;
        out.dv = (out.dv - out.point * wt) / w;
        out.duu = (out.duu - out.du * (2 * ws) - out.point * wss) / w;
        out.duv = (out.duv - out.du * wt - out.dv * ws - out.point * wst) / w;
        out.dvv = (out.dvv - out.dv * (2 * wt) - out.point * wtt) / w;
    }
    return out;
}

// Control points of the derivatives are differences of the patch's; none is kept.
BezierCell::Spread BezierCell::polynomial_spread() const
{
    const auto square = [](Vec3d a) {
        return dot(a, a);
    };
    const double p = static_cast<double>(count_s_ - 1);
    const double q = static_cast<double>(count_t_ - 1);
    Spread e{0, 0, 0, 0, 0, 0};
    for (std::size_t i = 0; i < count_s_; ++i) {
        for (std::size_t j = 0; j < count_t_; ++j) {
            const Vec3d* c = &points_[i * count_t_ + j];
            const bool next_s = i + 1 < count_s_;
            const bool next_t = j + 1 < count_t_;
            e.point = std::max(e.point, square(c[0] - middle_.point));
            if (next_s) {
                e.ds = std::max(e.ds, square((c[count_t_] - c[0]) * p - middle_.du));
            }
            if (next_t) {
                e.dt = std::max(e.dt, square((c[1] - c[0]) * q - middle_.dv));
            }
            if (next_s && next_t) {
                const Vec3d twist = c[count_t_ + 1] - c[count_t_] - (c[1] - c[0]);
                e.dst = std::max(e.dst, square(twist * (p * q) - middle_.duv));
            }
            if (i + 2 < count_s_) {
                const Vec3d bend = c[2 * count_t_] - c[count_t_] - (c[count_t_] - c[0]);
                e.dss = std::max(e.dss, square(bend * (p * (p - 1)) - middle_.duu));
            }
            if (j + 2 < count_t_) {
                const Vec3d bend = c[2] - c[1] - (c[1] - c[0]);
                e.dtt = std::max(e.dtt, square(bend * (q * (q - 1)) - middle_.dvv));
            }
        }
    }
    return {std::sqrt(e.point), std::sqrt(e.ds),  std::sqrt(e.dt),
            std::sqrt(e.dss),   std::sqrt(e.dst), std::sqrt(e.dtt)};
}

// With the middle as origin the quotient rule of the derivatives, in interval arithmetic.
BezierCell::Spread BezierCell::rational_spread() const
{
    Net<Vec3d> net{count_s_, count_t_, points_};
    const Net<double> weight{count_s_, count_t_, weights_};
    for (std::size_t k = 0; k < net.values.size(); ++k) {
        net.values[k] = net.values[k] - middle_.point * weights_[k];
    }
    const Net<Vec3d> s = net.along_s();
    const Net<Vec3d> t = net.along_t();
    const Net<double> weight_s = weight.along_s();
    const Net<double> weight_t = weight.along_t();
    const Enclosure w = range(weight);
    const Enclosure ws = range(weight_s);
    const Enclosure wt = range(weight_t);
    const Enclosure two{2, 2};
    const Box p = quotient(range(net), w);
    const Box ps = quotient(minus_product(range(s), p, ws), w);
    const Box pt = quotient(minus_product(range(t), p, wt), w);
    const Box pss = quotient(minus_product(minus_product(range(s.along_s()), ps, two * ws), p,
                                           range(weight_s.along_s())),
                             w);
    const Box pst =
        quotient(minus_product(minus_product(minus_product(range(s.along_t()), ps, wt), pt, ws), p,
                               range(weight_s.along_t())),
                 w);
    const Box ptt = quotient(minus_product(minus_product(range(t.along_t()), pt, two * wt), p,
                                           range(weight_t.along_t())),
                             w);
    return {farthest(p, {}),
            farthest(ps, middle_.du),
            farthest(pt, middle_.dv),
            farthest(pss, middle_.duu),
            farthest(pst, middle_.duv),
            farthest(ptt, middle_.dvv)};
}

void BezierCell::find_bounds()
{
    middle_ = at(0.5, 0.5);
    spread_ = weights_.empty() ? polynomial_spread() : rational_spread();
    const Vec3d normal = upward_normal(middle_);
    if (dot(normal, normal) > 0) {
        const Vec3d along = middle_.du / norm(middle_.du);
        axes_ = {normal, along, cross(normal, along)};
    } else {
        axes_ = {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
    }
    constexpr double kFar = std::numeric_limits<double>::infinity();
    low_ = {kFar, kFar, kFar};
    high_ = -low_;
    box_low_ = {kFar, kFar, kFar};
    box_high_ = {-kFar, -kFar, -kFar};
    for (std::size_t i = 0; i < count_s_; ++i) {
        for (std::size_t j = 0; j < count_t_; ++j) {
            const Vec3d p = control(i, j);
            for (unsigned k = 0; k < 3; ++k) {
                low_[k] = std::min(low_[k], p[k]);
                high_[k] = std::max(high_[k], p[k]);
                const double along = dot(p - middle_.point, axes_[k]);
                box_low_[k] = std::min(box_low_[k], along);
                box_high_[k] = std::max(box_high_[k], along);
            }
        }
    }
}

std::array<const BezierCell*, 2> BezierCell::halves() const
{
    if (!halves_[0]) {
        std::array<std::unique_ptr<BezierCell>, 2> half;
        const bool across_u = norm(middle_.du) >= norm(middle_.dv);
        for (std::size_t k = 0; k < 2; ++k) {
            half[k].reset(new BezierCell);
            half[k]->surface_ = surface_;
            half[k]->count_s_ = count_s_;
            half[k]->count_t_ = count_t_;
            half[k]->points_.resize(points_.size());
            half[k]->weights_.resize(weights_.size());
            const double u_middle = 0.5 * (u_begin_ + u_end_);
            const double v_middle = 0.5 * (v_begin_ + v_end_);
            half[k]->u_begin_ = across_u && k == 1 ? u_middle : u_begin_;
            half[k]->u_end_ = across_u && k == 0 ? u_middle : u_end_;
            half[k]->v_begin_ = !across_u && k == 1 ? v_middle : v_begin_;
            half[k]->v_end_ = !across_u && k == 0 ? v_middle : v_end_;
            half[k]->trim_ = trim_ == Trim::kCut ? Trim::kUnknown : trim_;
        }
        const std::size_t lines = across_u ? count_t_ : count_s_;
        const std::size_t count = across_u ? count_s_ : count_t_;
        const std::size_t stride = across_u ? count_t_ : 1;
        for (std::size_t line = 0; line < lines; ++line) {
            const std::size_t first = across_u ? line : line * count_t_;
            halve(&points_[first], &half[0]->points_[first], &half[1]->points_[first], count,
                  stride);
            if (!weights_.empty()) {
                halve(&weights_[first], &half[0]->weights_[first], &half[1]->weights_[first], count,
                      stride);
            }
        }
        half[0]->find_bounds();
        half[1]->find_bounds();
        halves_[0] = std::move(half[0]);
        halves_[1] = std::move(half[1]);
    }
    return {halves_[0].get(), halves_[1].get()};
}

}  // namespace cusp::host
