// The step across is perpendicular to the isocurve on the surface.
#include "host_tools/cam/adaptive_isocurve/cross_section.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::adaptive_isocurve {

using nurbs::SurfacePoint;

namespace {

// At a pole the only direction across is that of v.
CrossSection cross_section_at_pole(const SurfacePoint& p)
{
    const double square = dot(p.dv, p.dv);
    return {square > 0 ? -dot(upward_normal(p), p.dvv) / square : 0, std::sqrt(square)};
}

}  // namespace

CrossSection cross_section_at(const SurfacePoint& p)
{
    if (at_pole(p.du, p)) {
        return cross_section_at_pole(p);
    }
    // All curves meet here: there is no direction across.
    if (at_pole(p.dv, p)) {
        return {0, std::sqrt(dot(p.dv, p.dv))};
    }
    const double e = dot(p.du, p.du);
    const Vec3d normal = upward_normal(p);
    if (dot(normal, normal) == 0) {
        return {0, 0};
    }
    const double a = -dot(p.du, p.dv) / e;
    const Vec3d across = p.dv + p.du * a;
    const Vec3d bend = p.duu * (a * a) + p.duv * (2 * a) + p.dvv;
    const double square = dot(across, across);
    const double curvature = square > 0 ? -dot(normal, bend) / square : 0;
    // Rounding decides which side of a horizontal normal is up: the curvature that requires more
    // passes is used.
    return {normal.z < kLevelNormal ? std::abs(curvature) : curvature, std::sqrt(square)};
}

}  // namespace cusp::adaptive_isocurve
