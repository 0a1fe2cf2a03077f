// Passes a full stepover apart everywhere: each follows its neighbour rather than an isocurve, and
// where the surface widens new passes begin between others.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// Steps between passes per unit of v, at a point of the surface: |S_v| over the allowed distance.
// `apart`: the range of v that the point represents.
using StepDensity = std::function<double(const nurbs::SurfacePoint&, double apart)>;

// Judges the strip between two neighbouring curves at a u: returns the factor by which the density
// has to grow; 1 or less accepts the strip. A factor of at most `sufficient` may be replaced by any
// value between it and `sufficient`.
using StripJudge =
    std::function<double(double u, CurvePlace low, CurvePlace high, double sufficient)>;

using SurfaceFunction = std::function<nurbs::SurfacePoint(double u, double v)>;

struct EqualScallopPasses {
    std::vector<DomainCurve> curves;
    double worst{};  // largest factor in the last round of the judge
};

// Isocurves divide the surface into strips of equal numbers of steps. The number of strips is the
// one of least total length. In a strip, passes are whole steps away from either side and meet in
// the middle; the sides are complete isocurves. Neighbours are at most a step apart at every u, by
// the integral of the density over v, to the accuracy of the quadrature over the nodes.
//
// The judge, if given, is first called at every node of u, and the density becomes what it
// requires, lower as well as higher: slanting passes may be farther apart than isocurves. Then it
// is called between the nodes as well, and the density grows where it requires more, in at most 24
// rounds.
//
// Isocurves alone would be longer: sets of isocurves that grow by insertion, halving included, are
// on average 1/ln 2 = 1.44 times as dense as needed (de Bruijn & Erdos 1949).
EqualScallopPasses equal_scallop_passes(const nurbs::Surface& surface,
                                        int number,
                                        const SurfaceFunction& at,
                                        const StepDensity& density,
                                        const StripJudge& judge);

}  // namespace cusp::adaptive_isocurve
