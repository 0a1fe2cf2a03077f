// The scallop proved for passes at a given distance, where the job requests no scallop.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/mesh_check.hpp"

namespace cusp::finishing {

// The start of the search for a bound, all in mm.
struct ScallopGuess {
    double scallop_height;  // between neighbours if known, else 0 or kInfinite
    double spacing;         // of neighbours
    double radius;          // of the ball
    double outward;         // maximum distance of passes off the surface
};

struct ProvedScallop {
    double bound;         // mm
    double beside_edges;  // mm: ScallopCheck::left_beside_edges()
    double over_nothing;  // mm: ScallopCheck::over_nothing(); 0 where the bound is the radius
};

// Nearly the least bound for which `ScallopCheck` leaves no cell uncovered where the tool can touch
// the surface; at most the radius. If it cannot touch, the stock left is measured at points, and
// a quarter is added.
//
// path_off  mm: maximum distance between the path that is cut and the passes given
// cut       all passes, by their tips
ProvedScallop proved_scallop(const std::vector<nurbs::Surface>& surfaces,
                             const GougeFreePathFitter& path_fitter,
                             double path_off,
                             const std::vector<Points>& cut,
                             const ScallopGuess& guess);

// The same for a mesh and any end, by `MeshCheck`: `most_left` is the bound. Where the tool cannot touch,
// nothing is added.
MeshLeft proved_mesh_scallop(const std::vector<Corners>& mesh,
                             const GougeFreePathFitter& path_fitter,
                             double path_off,
                             const std::vector<Points>& cut,
                             const ScallopGuess& guess);

}  // namespace cusp::finishing
