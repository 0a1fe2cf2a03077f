// Extraction of adaptive isocurves (Elber & Cohen), and of complete isocurves for comparison.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// Sub-isocurves at constant v that cover the surface.
//
// surface   not degenerate; trims are ignored
// distance  mm > 0: delta of the paper
//
// Returns curves in order of v, then u; those at both ends of v are complete. Neighbours are closer
// than `distance` at every u they share, and every point of the surface lies within `distance` of a
// curve. Pairs of near curves may enclose more surface (a fold, a closed surface). They are divided
// until the length of the surface between them, bounded by control points, is less than twice the
// distance.
//
// Source: Elber & Cohen 1993, algorithm 1. As printed it never adds the middle curve and so returns
// none. Here it adds each middle curve and the two boundaries.
std::vector<DomainCurve> adaptive_isocurves(const nurbs::Surface& surface,
                                            int number,
                                            double distance);

// Isocurves over all of u, equally spaced in v: the fewest with neighbours within `distance`.
std::vector<DomainCurve> complete_isocurves(const nurbs::Surface& surface,
                                            int number,
                                            double distance);

}  // namespace cusp::adaptive_isocurve
