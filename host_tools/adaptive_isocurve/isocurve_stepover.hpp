// How far apart two passes of a ball may be for a bound on the ridge between them.
#pragma once

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// A unit normal whose z is less counts as level: rounding decides which of its sides is up.
constexpr double kLevelNormal = 1e-7;

// The chord between two contacts of a ball for which the ridge between is `scallop` high.
//
// radius     mm > 0, of the ball
// scallop    mm > 0; at most the radius counts
// curvature  1/mm, of the surface across the passes; positive where it is hollow towards the tool.
//            From 0.98 / radius on the ball hardly fits: no more than that counts.
//
// Returns at most 1.8 radii.
// Source: Suh & Lee 1990, equation (16) as it should read, with the square root factored so that
// nothing cancels where the surface is flat.
double isocurve_stepover(double radius, double scallop, double curvature);

// Normal curvature across the isocurve of constant v, in the sense above, and the length of the
// surface across it for a unit of v. Zero speed where the surface is degenerate.
struct CrossSection {
    double curvature{};
    double speed{};
};
CrossSection cross_section_at(const nurbs::SurfacePoint& p);

}  // namespace cusp::adaptive_isocurve
