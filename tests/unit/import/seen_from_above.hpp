// The area in plan of surfaces, and their heights.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::test {

struct Seen {
    double area{};  // from above, of what the trims leave
    double low{1e9};
    double high{-1e9};
};

// Calls visit(point, du x dv of a place) at places of what the trims leave. They are spread evenly in (u, v), not
// in rows: trims that run along rows would count whole rows.
template <typename Visit>
void for_places(const std::vector<nurbs::Surface>& surfaces, const Visit& visit)
{
    constexpr int kLooks = 200;
    constexpr double kGolden = 0.61803398874989485;
    const auto in_row = [](int at, int row) {
        const double shift = kGolden * row;
        return at + shift - std::floor(shift);
    };
    for (const nurbs::Surface& s : surfaces) {
        std::vector<std::vector<Vec2d>> loops;
        for (const auto& loop : s.trims) {
            loops.push_back(job::loop_polyline(loop, 1e-5 * (s.u_end() - s.u_begin())));
        }
        const double du = (s.u_end() - s.u_begin()) / kLooks;
        const double dv = (s.v_end() - s.v_begin()) / kLooks;
        for (int k = 0; k < kLooks * kLooks; ++k) {
            const double u = s.u_begin() + in_row(k % kLooks, k / kLooks) * du;
            const double v = s.v_begin() + in_row(k / kLooks, k % kLooks) * dv;
            bool inside = loops.empty();
            for (const auto& loop : loops) {
                inside = inside != job::encloses(loop, {u, v});
            }
            const nurbs::SurfacePoint p = derivatives_at(s, u, v);
            if (inside) {
                visit(p.point, cross(p.du, p.dv) * (du * dv));
            }
        }
    }
}

inline Seen seen_from_above(const std::vector<nurbs::Surface>& surfaces)
{
    Seen seen;
    for_places(surfaces, [&](Vec3d point, Vec3d area) {
        seen.area += std::abs(area.z);
        seen.low = std::min(seen.low, point.z);
        seen.high = std::max(seen.high, point.z);
    });
    return seen;
}

}  // namespace cusp::test
