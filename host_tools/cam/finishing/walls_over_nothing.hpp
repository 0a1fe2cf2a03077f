// Length of free walls: a ball beside them would have nothing of the part below it.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/wall_facet.hpp"

namespace cusp::finishing {

// mm along walls, seen from above, of sides beside which a ball that touches the wall rests on nothing,
// as around a part: `WallSide` does not ask for the ball there. Facets over each other count once, the
// two sides of a sheet twice.
//
// Looked at once in each square of half a radius, by a ball a tenth smaller: right within about a radius
// for each stretch.
double walls_over_nothing(const std::vector<WallFacet>& facets,
                          const GougeFreePathFitter& path_fitter);

}  // namespace cusp::finishing
