// Evaluation by Bernstein polynomials, halving by de Casteljau.
#include "host_tools/geometry/part_model/bezier_cell.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace cusp::part_model {

using nurbs::BezierPatch;
using nurbs::SurfacePoint;

namespace {

constexpr std::size_t kMostControls = 32;

// Bernstein polynomials with first and second derivatives, of up to `Room` control points.
template <std::size_t Room>
struct Basis {
    std::array<double, Room> value;
    std::array<double, Room> first;
    std::array<double, Room> second;
};

template <std::size_t Room>
void raise_degree(std::array<double, Room>& row, std::size_t degree, double s)
{
    double carried = 0;
    for (std::size_t i = 0; i < degree; ++i) {
        const double b = row[i];
        row[i] = carried + (1 - s) * b;
        carried = s * b;
    }
    row[degree] = carried;
}

template <std::size_t Room>
void differences(const std::array<double, Room>& lower,
                 std::size_t degree,
                 std::array<double, Room>& out)
{
    const double p = static_cast<double>(degree);
    out[0] = -p * lower[0];
    for (std::size_t i = 1; i < degree; ++i) {
        out[i] = p * (lower[i - 1] - lower[i]);
    }
    out[degree] = p * lower[degree - 1];
}

template <std::size_t Room>
void bernstein(std::size_t degree, double s, Basis<Room>& out)
{
    std::array<double, Room> row;
    row[0] = 1;
    for (std::size_t k = 1; k + 1 < degree; ++k) {
        raise_degree(row, k, s);
    }
    if (degree >= 2) {
        std::array<double, Room> slope;
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

// The basis of a fixed degree, unrolled.
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

// The curves of t at one s: control points of the value and of its derivatives by s. Rows are
// summed as plain numbers so that the compiler vectorizes the loops.
template <std::size_t CountS, std::size_t CountT>
void reduce_to_curves(const Vec3d* points, double s, double* value, double* first, double* second)
{
    static_assert(sizeof(Vec3d) == 3 * sizeof(double));
    const auto bs = fixed_basis(std::integral_constant<std::size_t, CountS>{}, s);
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
}

template <std::size_t Count>
SurfacePoint on_curves(const std::array<double, 3 * Count>& value,
                       const std::array<double, 3 * Count>& first,
                       const std::array<double, 3 * Count>& second,
                       double t)
{
    const auto bt = fixed_basis(std::integral_constant<std::size_t, Count>{}, t);
    return {weighted<Count>(value, bt.value), weighted<Count>(first, bt.value),
            weighted<Count>(value, bt.first), weighted<Count>(second, bt.value),
            weighted<Count>(first, bt.first), weighted<Count>(value, bt.second)};
}

template <std::size_t CountS, std::size_t CountT>
SurfacePoint polynomial_at(const Vec3d* points, double s, double t)
{
    std::array<double, 3 * CountT> value;
    std::array<double, 3 * CountT> first;
    std::array<double, 3 * CountT> second;
    reduce_to_curves<CountS, CountT>(points, s, value.data(), first.data(), second.data());
    return on_curves<CountT>(value, first, second, t);
}

// As reduce_to_curves(), without second derivatives.
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

// Enough for a basis of so many control points, where they are known as this is compiled.
template <class Count>
constexpr std::size_t kRoomFor = kMostControls;
template <std::size_t Count>
constexpr std::size_t kRoomFor<std::integral_constant<std::size_t, Count>> =
    std::max<std::size_t>(Count, 2);

// Calls evaluate(count) with a constant for the usual numbers of control points: loops of known
// length are unrolled, and give the same to the last bit.
template <class Evaluate>
SurfacePoint with_fixed_count(std::size_t count, const Evaluate& evaluate)
{
    switch (count) {
        case 2:
            return evaluate(std::integral_constant<std::size_t, 2>{});
        case 3:
            return evaluate(std::integral_constant<std::size_t, 3>{});
        case 4:
            return evaluate(std::integral_constant<std::size_t, 4>{});
        case 6:
            return evaluate(std::integral_constant<std::size_t, 6>{});
        default:
            return evaluate(count);
    }
}

// weights  null: all 1
template <class CountS, class CountT>
SurfacePoint rational_at(
    CountS count_s, CountT count_t, const Vec3d* points, const double* weights, double s, double t)
{
    Basis<kRoomFor<CountS>> bs;
    Basis<kRoomFor<CountT>> bt;
    bernstein(count_s - 1, s, bs);
    bernstein(count_t - 1, t, bt);
    SurfacePoint out;
    double w = 0;
    double ws = 0;
    double wt = 0;
    double wss = 0;
    double wst = 0;
    double wtt = 0;
    for (std::size_t i = 0; i < count_s; ++i) {
        Vec3d p;
        Vec3d pt;
        Vec3d ptt;
        const Vec3d* row = &points[i * count_t];
        for (std::size_t j = 0; j < count_t; ++j) {
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
        for (std::size_t j = 0; weights != nullptr && j < count_t; ++j) {
            const double weight = weights[i * count_t + j];
            w += weight * bt.value[j] * bs.value[i];
            ws += weight * bt.value[j] * bs.first[i];
            wss += weight * bt.value[j] * bs.second[i];
            wt += weight * bt.first[j] * bs.value[i];
            wst += weight * bt.first[j] * bs.first[i];
            wtt += weight * bt.second[j] * bs.value[i];
        }
    }
    if (weights != nullptr) {
        out.point = out.point / w;
        out.du = (out.du - out.point * ws) / w;
        out.dv = (out.dv - out.point * wt) / w;
        out.duu = (out.duu - out.du * (2 * ws) - out.point * wss) / w;
        out.duv = (out.duv - out.du * wt - out.dv * ws - out.point * wst) / w;
        out.dvv = (out.dvv - out.dv * (2 * wt) - out.point * wtt) / w;
    }
    return out;
}

// De Casteljau's algorithm at the middle, for `count` values `stride` apart.
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

// In one piece of memory, and all control points in another: one query makes and releases thousands.
struct BezierCell::Halves {
    BezierCell lower;
    BezierCell upper;
    Controls controls;  // of the lower one, then of the upper one
};

BezierCell::BezierCell(const BezierPatch& patch, int surface, std::atomic<std::size_t>* made)
    : surface_{surface},
      made_{made},
      count_s_{static_cast<std::size_t>(patch.surface.size_u)},
      count_t_{static_cast<std::size_t>(patch.surface.size_v)},
      u_begin_{patch.u_begin},
      u_end_{patch.u_end},
      v_begin_{patch.v_begin},
      v_end_{patch.v_end}
{
    const std::vector<double>& weights = patch.surface.weights;
    const auto [smallest, largest] = std::minmax_element(weights.begin(), weights.end());
    auto controls = std::make_unique<Controls>(Controls{patch.surface.points, {}});
    if (*smallest != *largest) {
        controls->weights = weights;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            controls->points[k] = controls->points[k] * weights[k];
        }
        weights_ = controls->weights.data();
    }
    points_ = controls->points.data();
    controls_ = std::move(controls);
    find_bounds();
}

Vec3d BezierCell::control(std::size_t i, std::size_t j) const
{
    const std::size_t k = i * count_t_ + j;
    return weights_ == nullptr ? points_[k] : points_[k] / weights_[k];
}

SurfacePoint BezierCell::at(double s, double t) const
{
    if (weights_ == nullptr && count_s_ == 4 && count_t_ == 4) {
        return polynomial_at<4, 4>(points_, s, t);
    }
    if (weights_ == nullptr && count_s_ == 2 && count_t_ == 2) {
        return polynomial_at<2, 2>(points_, s, t);
    }
    return at_any_degree(s, t);
}

SurfacePoint BezierCell::by_domain(SurfacePoint p) const
{
    const double width_u = u_end_ - u_begin_;
    const double width_v = v_end_ - v_begin_;
    p.du = p.du / width_u;
    p.dv = p.dv / width_v;
    p.duu = p.duu / (width_u * width_u);
    p.duv = p.duv / (width_u * width_v);
    p.dvv = p.dvv / (width_v * width_v);
    return p;
}

SurfacePoint BezierCell::tangents_at(double s, double t) const
{
    if (weights_ == nullptr && count_s_ == 4 && count_t_ == 4) {
        return tangents<4, 4>(points_, s, t);
    }
    return at(s, t);
}

bool BezierCell::cut_at(double s, Curve4& out) const
{
    if (weights_ != nullptr || count_s_ != 4 || count_t_ != 4) {
        return false;
    }
    reduce_to_curves<4, 4>(points_, s, out.value.data(), out.along_s.data(), out.along_ss.data());
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

SurfacePoint BezierCell::bends_on_cut(const Curve4& cut, double t)
{
    return on_curves<4>(cut.value, cut.along_s, cut.along_ss, t);
}

// Any degree, and rational cells.
SurfacePoint BezierCell::at_any_degree(double s, double t) const
{
    const double* const weights = weights_;
    return with_fixed_count(count_s_, [&](auto count_s) {
        return with_fixed_count(count_t_, [&](auto count_t) {
            return rational_at<decltype(count_s), decltype(count_t)>(count_s, count_t, points_,
                                                                     weights, s, t);
        });
    });
}

bool BezierCell::is_halved_across_u() const
{
    // If a derivative falls to nothing towards a side, as beside coincident control points, no
    // convexity is proved before the cell is far narrower than long: 1e3 times here. Halved by length
    // alone, such a strip took 50 000 cells a query.
    constexpr double kNarrow = 1e3;
    constexpr double kVanishing = 0.9;
    const double du = norm(middle_.du);
    const double dv = norm(middle_.dv);
    const bool u_vanishes = spread_.ds > kVanishing * du;
    const bool v_vanishes = spread_.dt > kVanishing * dv;
    if (u_vanishes && !v_vanishes) {
        return du >= dv || kNarrow * (norm(middle_.duu) + spread_.dss) >= dv;
    }
    if (v_vanishes && !u_vanishes) {
        return du >= dv && kNarrow * (norm(middle_.dvv) + spread_.dtt) < du;
    }
    return du >= dv;
}

std::array<const BezierCell*, 2> BezierCell::halves() const
{
    if (Halves* const known = halves_) {
        return {&known->lower, &known->upper};
    }
    auto made = std::make_unique<Halves>();
    const std::size_t controls = count_s_ * count_t_;
    made->controls.points.resize(2 * controls);
    made->controls.weights.resize(weights_ == nullptr ? 0 : 2 * controls);
    const bool across_u = is_halved_across_u();
    for (std::size_t k = 0; k < 2; ++k) {
        BezierCell& half = k == 0 ? made->lower : made->upper;
        begin_half(half, across_u, k == 1);
        half.points_ = &made->controls.points[k * controls];
        half.weights_ = weights_ == nullptr ? nullptr : &made->controls.weights[k * controls];
    }
    const std::size_t lines = across_u ? count_t_ : count_s_;
    const std::size_t count = across_u ? count_s_ : count_t_;
    const std::size_t stride = across_u ? count_t_ : 1;
    for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t first = across_u ? line : line * count_t_;
        Vec3d* const points = &made->controls.points[first];
        halve(&points_[first], points, points + controls, count, stride);
        if (weights_ != nullptr) {
            double* const weights = &made->controls.weights[first];
            halve(&weights_[first], weights, weights + controls, count, stride);
        }
    }
    made->lower.find_bounds();
    made->upper.find_bounds();
    Halves* known = nullptr;
    if (halves_.compare_exchange_strong(known, made.get())) {
        known = made.release();
        if (made_ != nullptr) {
            *made_ += 2;
        }
    }
    return {&known->lower, &known->upper};
}

// All but its control points and what follows from them.
void BezierCell::begin_half(BezierCell& half, bool across_u, bool upper) const
{
    half.surface_ = surface_;
    half.made_ = made_;
    half.count_s_ = count_s_;
    half.count_t_ = count_t_;
    const double u_middle = 0.5 * (u_begin_ + u_end_);
    const double v_middle = 0.5 * (v_begin_ + v_end_);
    half.u_begin_ = across_u && upper ? u_middle : u_begin_;
    half.u_end_ = across_u && !upper ? u_middle : u_end_;
    half.v_begin_ = !across_u && upper ? v_middle : v_begin_;
    half.v_end_ = !across_u && !upper ? v_middle : v_end_;
    half.first_u_ = first_u_ && !(across_u && upper);
    half.last_u_ = last_u_ && !(across_u && !upper);
    half.first_v_ = first_v_ && (across_u || !upper);
    half.last_v_ = last_v_ && (across_u || upper);
    const Trim trim = trim_;
    half.trim_ = trim == Trim::kCut ? Trim::kUnknown : trim;
}

void BezierCell::forget() const
{
    delete halves_.exchange(nullptr);
    delete surroundings_.exchange(nullptr);
    delete near_patches_.exchange(nullptr);
}

BezierCell::~BezierCell() { forget(); }

void BezierCell::set_surroundings(const Surroundings& found) const
{
    auto made = std::make_unique<const Surroundings>(found);
    const Surroundings* known = nullptr;
    if (surroundings_.compare_exchange_strong(known, made.get())) {
        static_cast<void>(made.release());
    }
}

const BezierCell::NearPatches& BezierCell::set_near_patches(
    std::unique_ptr<NearPatches> found) const
{
    const NearPatches* known = near_patches_;
    do {
        static_cast<void>(found->older.release());
        found->older.reset(known);
    } while (!near_patches_.compare_exchange_weak(known, found.get()));
    return *found.release();
}

}  // namespace cusp::part_model
