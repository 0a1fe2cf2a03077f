// One pass leaves more the farther from it, the other less: the ridge is where both leave the same.
#include "host_tools/adaptive_isocurve/ridge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cusp::host {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();
constexpr int kTurns = 8;

// A ball that moves straight.
struct Sweep {
    Vec3d centre;
    Vec3d tangent;

    Sweep(const SurfacePoint& p, double slope, const RidgeTool& tool)
        : centre{p.point + upward_normal(p) * (tool.radius + tool.outward)},
          tangent{p.du + p.dv * slope}
    {
        tangent = tangent / std::max(1e-300, norm(tangent));
    }

    // What it leaves over the point along its normal.
    double left(const SurfacePoint& p, double radius) const
    {
        Vec3d q = p.point - centre;
        q = q - tangent * dot(q, tangent);
        Vec3d n = upward_normal(p);
        n = n - tangent * dot(n, tangent);
        const double a = dot(n, n);
        const double b = dot(q, n);
        const double square = b * b - a * (dot(q, q) - radius * radius);
        if (square < 0 || a == 0) {
            return kUnreached;
        }
        return (-b - std::sqrt(square)) / a;
    }
};

}  // namespace

double ridge_between(const SurfaceFunction& at,
                     const RidgeTool& tool,
                     double u,
                     CurvePlace low_place,
                     CurvePlace high_place)
{
    const Sweep low{at(u, low_place.v), low_place.slope, tool};
    const Sweep high{at(u, high_place.v), high_place.slope, tool};
    double from = low_place.v;
    double to = high_place.v;
    double bound = kUnreached;
    double v = 0.5 * (from + to);
    for (int turn = 0; turn < kTurns; ++turn) {
        const SurfacePoint p = at(u, v);
        const double by_low = low.left(p, tool.radius);
        const double by_high = high.left(p, tool.radius);
        bound = std::min(bound, std::max(by_low, by_high));
        const double excess = by_low - by_high;
        if (excess == 0 || std::abs(excess) < 0.002 * bound) {
            break;
        }
        (excess > 0 ? to : from) = v;
        // The difference is nearly linear across, and as large at the ends as the step is wide.
        const double width = high_place.v - low_place.v;
        const double scale = std::isfinite(excess) ? 2 * std::max(by_low, by_high) : kUnreached;
        const double guess = v - 0.5 * width * excess / (2 * scale);
        v = std::isfinite(guess) && guess > from && guess < to ? guess : 0.5 * (from + to);
    }
    return bound;
}

double highest_ridge(const SurfaceFunction& at,
                     const RidgeTool& tool,
                     const std::vector<DomainCurve>& curves,
                     double u_begin,
                     double u_end,
                     int count)
{
    double worst = 0;
    for (int k = 0; k <= count; ++k) {
        const double u = u_begin + (u_end - u_begin) * k / count;
        const std::vector<CurvePlace> across = places_at(curves, u);
        for (std::size_t j = 1; j < across.size(); ++j) {
            worst = std::max(worst, ridge_between(at, tool, u, across[j - 1], across[j]));
        }
    }
    return worst;
}

}  // namespace cusp::host
