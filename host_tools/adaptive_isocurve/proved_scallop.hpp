// The scallop that passes laid at a given distance leave: no scallop was asked for, cells prove
// one.
#pragma once

#include "host_tools/finishing/gouge_free_path.hpp"

namespace cusp::adaptive_isocurve {

// What the search for a bound begins with, all in mm.
struct ScallopGuess {
    double scallop_height;  // between neighbours, where that is known; else 0 or infinite
    double spacing;         // of neighbours
    double radius;          // of the ball
    double outward;         // how far passes may stay above the surface
};

struct ProvedScallop {
    double bound;         // mm
    double beside_edges;  // mm: Coverage::left_beside_edges
};

// About the least bound for which Coverage leaves no cell bare where the tool can touch, at most
// the radius. Where the tool can't touch, what is left is measured at places, and a quarter added.
//
// path_off  mm: how far the path that is cut may be from the passes given
// cut       all passes, by their tips
ProvedScallop proved_scallop(const std::vector<nurbs::Surface>& surfaces,
                             const finishing::GougeFreePathFitter& path_fitter,
                             double path_off,
                             const std::vector<finishing::Points>& cut,
                             const ScallopGuess& guess);

}  // namespace cusp::adaptive_isocurve
