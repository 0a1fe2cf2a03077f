// Passes a full step apart everywhere: where the surface widens, passes begin between others, and
// each follows its neighbour rather than an isocurve.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// Steps between passes for a unit of v, at a place of the surface: |S_v| over the allowed distance.
using StepDensity = std::function<double(const nurbs::SurfacePoint&)>;

// What lies between two neighbouring curves at a u, to be refused with the factor by which the
// density must grow; 1 or less accepts.
// Any value that is no less than it and no more than `sufficient` will do.
using StripJudge =
    std::function<double(double u, CurvePlace low, CurvePlace high, double sufficient)>;

using SurfaceFunction = std::function<nurbs::SurfacePoint(double u, double v)>;

struct EqualScallopPasses {
    std::vector<DomainCurve> curves;
    double worst{};  // largest factor the judge still asked for
};

// The surface is cut by isocurves into strips of equal numbers of steps, as many as make the whole
// shortest. In a strip passes are whole steps away from either side and meet in the middle; the
// strip's sides are isocurves, and complete. Neighbours are at most a step apart at every u, by the
// integral of the density over v (exact to the accuracy of a quadrature over `nodes` places).
//
// The judge, where given, is asked at every node of u first, and the density made what it asks for,
// less as well as more: slanting passes may be farther apart than isocurves. Then it is asked
// between the nodes, too; places where it asks for more get it, and in the last of eight rounds
// all does. `worst` says what was asked for last.
//
// Why not isocurves alone: whatever their order, sets of isocurves that grow by insertion are
// 1/ln 2 = 1.44 times as dense as needed on the average (de Bruijn & Erdos 1949), halving included.
EqualScallopPasses equal_scallop_passes(const nurbs::Surface& surface,
                                        int number,
                                        const SurfaceFunction& at,
                                        const StepDensity& density,
                                        const StripJudge& judge);

}  // namespace cusp::adaptive_isocurve
