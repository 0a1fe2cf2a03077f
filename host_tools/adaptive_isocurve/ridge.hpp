// The ridge that a ball leaves between two neighbouring passes of one surface.
#pragma once

#include "host_tools/adaptive_isocurve/even_spacing.hpp"

namespace cusp::host {

struct RidgeTool {
    double radius{};   // mm, of the ball
    double outward{};  // mm: farthest that the path lies off the surface
};

// Height of what is left at u between two passes, square to the surface; infinity
// where the ball of neither pass reaches. Both passes count as straight along their tangents there.
//
// Returns a bound: never below the ridge where the way across is shorter than the ball is wide.
double ridge_between(
    const SurfaceFunction& at, const RidgeTool& tool, double u, CurvePlace low, CurvePlace high);

// The highest ridge over all neighbours at `count` places along u.
double highest_ridge(const SurfaceFunction& at,
                     const RidgeTool& tool,
                     const std::vector<DomainCurve>& curves,
                     double u_begin,
                     double u_end,
                     int count);

}  // namespace cusp::host
