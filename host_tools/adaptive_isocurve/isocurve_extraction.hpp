// Adaptive isocurves as Elber and Cohen extract them, and the complete ones they are compared with.
#pragma once

#include <vector>

#include "host_tools/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// Sub-isocurves at constant v that cover the surface.
//
// surface   not degenerate; trims are not looked at
// distance  mm > 0: delta of the paper
//
// Returns curves in order of v, then u; those at both ends of v come complete. Neighbours are
// closer than `distance` at every u they share, and every point of the surface lies within
// `distance` of a curve: pairs that are near each other but may enclose more (a fold, a closed
// surface) are split on until the length of the surface between them, bounded by its control
// points, is under twice the distance.
//
// Source: Elber & Cohen 1993, algorithm 1. As printed it returns no curve at all: the middle curve
// is never added. Here each middle curve and the two boundaries are.
std::vector<DomainCurve> adaptive_isocurves(const nurbs::Surface& surface,
                                            int number,
                                            double distance);

// Isocurves over the whole of u, equally spaced in v, the fewest for which neighbours are within
// `distance`.
std::vector<DomainCurve> complete_isocurves(const nurbs::Surface& surface,
                                            int number,
                                            double distance);

}  // namespace cusp::adaptive_isocurve
