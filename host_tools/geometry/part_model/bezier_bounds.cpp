// Bounds of the spread of a cell and its derivatives, from convex hulls of control points.
#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/enclosure.hpp"

namespace cusp::part_model {
namespace {

// A box of vectors, with the interval arithmetic of the quotient rule.
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
        Enclosure side{kInfinite, -kInfinite};
        for (const Vec3d& value : net.values) {
            side = {std::min(side.low, value[axis]), std::max(side.high, value[axis])};
        }
        box.side[axis] = side;
    }
    return box;
}

}  // namespace

// Control points of the derivatives are differences of those of the patch, computed on the fly.
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

// The quotient rule of the derivatives in interval arithmetic, with the middle as origin.
BezierCell::Spread BezierCell::rational_spread() const
{
    const std::size_t controls = count_s_ * count_t_;
    Net<Vec3d> net{count_s_, count_t_, {points_, points_ + controls}};
    const Net<double> weight{count_s_, count_t_, {weights_, weights_ + controls}};
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
    spread_ = weights_ == nullptr ? polynomial_spread() : rational_spread();
    const Vec3d normal = upward_normal(middle_);
    if (dot(normal, normal) > 0) {
        const Vec3d along = middle_.du / norm(middle_.du);
        axes_ = {normal, along, cross(normal, along)};
    } else {
        axes_ = {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
    }
    low_ = {kInfinite, kInfinite, kInfinite};
    high_ = -low_;
    box_low_ = {kInfinite, kInfinite, kInfinite};
    box_high_ = {-kInfinite, -kInfinite, -kInfinite};
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

}  // namespace cusp::part_model
