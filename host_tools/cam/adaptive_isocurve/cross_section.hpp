// The section of a surface across its isocurves: what their stepover depends on.
#pragma once

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// A unit normal with a smaller z counts as horizontal: rounding decides which of its sides is up.
constexpr double kLevelNormal = 1e-7;

// Normal curvature across the isocurve of constant v, 1/mm, > 0 where the surface is convex, as
// toolpath::stepover() takes it; and the length of the surface across it for a unit of v. Zero
// speed where the surface is degenerate.
struct CrossSection {
    double curvature{};
    double speed{};
};
CrossSection cross_section_at(const nurbs::SurfacePoint& p);

}  // namespace cusp::adaptive_isocurve
