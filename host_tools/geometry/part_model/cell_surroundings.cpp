// Bounds on the bend of a cell and its neighbours, from their control points.
#include "host_tools/geometry/part_model/cell_surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/nearest_search.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

bool lies_in(const BezierCell& cell, const BezierCell::Surroundings& box)
{
    return cell.u_begin() >= box.u_begin && cell.u_end() <= box.u_end &&
           cell.v_begin() >= box.v_begin && cell.v_end() <= box.v_end;
}

namespace {

constexpr double kMostSkew = 0.9;     // cosine between du and dv
constexpr double kMostShorter = 0.9;  // of a length in the tangent plane

BezierCell::Spread scaled_spread(const BezierCell& cell)
{
    const double width_u = cell.u_end() - cell.u_begin();
    const double width_v = cell.v_end() - cell.v_begin();
    BezierCell::Spread e = cell.spread();
    e.ds /= width_u;
    e.dt /= width_v;
    e.dss /= width_u * width_u;
    e.dst /= width_u * width_v;
    e.dtt /= width_v * width_v;
    return e;
}

// Bounds of the difference between derivatives in the surroundings and at the middle of the cell.
class BendBound {
public:
    explicit BendBound(const BezierCell& cell)
        : middle_{cell.by_domain(cell.middle())},
          own_{scaled_spread(cell)},
          normal_{upward_normal(middle_)}
    {
    }

    void add(const BezierCell& cell)
    {
        const SurfacePoint p = cell.by_domain(cell.middle());
        const BezierCell::Spread e = scaled_spread(cell);
        across_u_ = std::max(across_u_, in_plane(p.du - middle_.du) + e.ds);
        across_v_ = std::max(across_v_, in_plane(p.dv - middle_.dv) + e.dt);
        climb_u_ = std::max(climb_u_, std::abs(p.du.z - middle_.du.z) + e.ds);
        climb_v_ = std::max(climb_v_, std::abs(p.dv.z - middle_.dv.z) + e.dt);
        const auto bend = [&](Vec3d d, Vec3d from, double spread) {
            return std::abs(dot(d - from, normal_)) + spread;
        };
        bend_uu_ = std::max(bend_uu_, bend(p.duu, middle_.duu, e.dss));
        bend_uv_ = std::max(bend_uv_, bend(p.duv, middle_.duv, e.dst));
        bend_vv_ = std::max(bend_vv_, bend(p.dvv, middle_.dvv, e.dtt));
        most_uu_ = std::max(most_uu_, norm(p.duu) + e.dss);
        most_uv_ = std::max(most_uv_, norm(p.duv) + e.dst);
        most_vv_ = std::max(most_vv_, norm(p.dvv) + e.dtt);
        top_ = std::max(top_, cell.high().z);
    }

    // Writes the bounds into `box`; leaves `extra_bend` at kInfinite where nothing is proved.
    void fill(BezierCell::Surroundings& box) const
    {
        box.top = top_;
        box.extra_bend = kInfinite;
        const double e = dot(middle_.du, middle_.du);
        const double f = dot(middle_.du, middle_.dv);
        const double g = dot(middle_.dv, middle_.dv);
        const double det = e * g - f * f;
        const double skew = std::abs(f) / std::sqrt(e * g);
        if (!(det > 0) || !(skew < kMostSkew)) {
            return;
        }
        const double long_u = std::sqrt(e);
        const double long_v = std::sqrt(g);
        // The tangent plane of the cell tilts by no more than this (a tangent).
        const double lean = own_.ds * std::sqrt(g / det) + own_.dt * std::sqrt(e / det);
        const double tilt = lean / (1 - lean);
        const double straight = 1 - skew;
        const double shorter =
            elementary::hypot(across_u_ / long_u, across_v_ / long_v) / std::sqrt(straight);
        if (!(lean < 0.5) || !(normal_.z > tilt) || !(shorter < kMostShorter)) {
            return;
        }
        const double uu = (bend_uu_ + tilt * most_uu_) / e;
        const double uv = (bend_uv_ + tilt * most_uv_) / (long_u * long_v);
        const double vv = (bend_vv_ + tilt * most_vv_) / g;
        box.metric = {e, f, g};
        box.bend = {dot(normal_, middle_.duu), dot(normal_, middle_.duv),
                    dot(normal_, middle_.dvv)};
        box.nearness = (1 - shorter) * (1 - shorter);
        box.extra_bend = (std::max(uu, vv) + uv) / straight;
        box.climb = elementary::hypot(normal_.x, normal_.y) +
                    elementary::hypot(climb_u_ / long_u, climb_v_ / long_v) / std::sqrt(straight);
    }

private:
    double in_plane(Vec3d d) const { return norm(d - normal_ * dot(d, normal_)); }

    SurfacePoint middle_;
    BezierCell::Spread own_;
    Vec3d normal_;
    double across_u_{};
    double across_v_{};
    double climb_u_{};
    double climb_v_{};
    double bend_uu_{};
    double bend_uv_{};
    double bend_vv_{};
    double most_uu_{};
    double most_uv_{};
    double most_vv_{};
    double top_{-kInfinite};
};

bool overlaps(const BezierCell& cell, const BezierCell::Surroundings& box)
{
    return cell.u_begin() < box.u_end && cell.u_end() > box.u_begin && cell.v_begin() < box.v_end &&
           cell.v_end() > box.v_begin;
}

void add_part(const BezierCell& cell,
              const BezierCell::Surroundings& box,
              double width_u,
              double width_v,
              BendBound& bound)
{
    if (!overlaps(cell, box)) {
        return;
    }
    // Beside a pole cells are halved along one parameter only: the next one to be halved decides.
    const bool small = norm(cell.middle().du) >= norm(cell.middle().dv)
                           ? cell.u_end() - cell.u_begin() <= 1.5 * width_u
                           : cell.v_end() - cell.v_begin() <= 1.5 * width_v;
    if (small || lies_in(cell, box)) {
        bound.add(cell);
        return;
    }
    for (const BezierCell* half : cell.halves()) {
        add_part(*half, box, width_u, width_v, bound);
    }
}

// Widened by its width on either side, up to the next crease.
std::array<double, 2> widened(const std::vector<double>& creases, double begin, double end)
{
    const double width = 1.001 * (end - begin);
    const auto above = std::lower_bound(creases.begin() + 1, creases.end() - 1, end);
    const auto below = std::upper_bound(creases.begin() + 1, creases.end() - 1, begin) - 1;
    return {std::max(*below, begin - width), std::min(*above, end + width)};
}

}  // namespace

BezierCell::Surroundings find_surroundings(const PartModel::State& state, const BezierCell& cell)
{
    const PartModel::State::Grid& grid = state.grids[static_cast<std::size_t>(cell.surface())];
    const auto [u_begin, u_end] = widened(grid.creases_u, cell.u_begin(), cell.u_end());
    const auto [v_begin, v_end] = widened(grid.creases_v, cell.v_begin(), cell.v_end());
    BezierCell::Surroundings box{u_begin, u_end, v_begin, v_end, {}, {}, 0, kInfinite, 0, 0};
    const auto first = [](const std::vector<double>& breaks, double at) {
        return static_cast<std::size_t>(std::upper_bound(breaks.begin() + 1, breaks.end(), at) -
                                        breaks.begin()) -
               1;
    };
    BendBound bound{cell};
    for (std::size_t i = first(grid.u, u_begin); i < grid.u.size() && grid.u[i] < u_end; ++i) {
        for (std::size_t j = first(grid.v, v_begin); j < grid.v.size() && grid.v[j] < v_end; ++j) {
            add_part(*state.cells[grid.first + i * grid.v.size() + j], box,
                     cell.u_end() - cell.u_begin(), cell.v_end() - cell.v_begin(), bound);
        }
    }
    bound.fill(box);
    return box;
}

}  // namespace cusp::part_model
