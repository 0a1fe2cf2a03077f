// The vertical parts of trimmed surfaces as plane facets, and how far the part may be off these.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/wall_facet.hpp"

namespace cusp::finishing {

// Cells of the domain are halved until each is plane within a small share of the scallop and of the
// band; of each remains what is vertical, as ScallopAtPoint::is_upright() has it. A plane face stays
// whole, and its facets are exact. Facets less high than a fiftieth of the scallop are left out:
// what stays there could exceed the scallop by that much.
//
// How far a curved face is off its facet, and how far its normal is off that of the facet, is bounded
// by `WallCell`. A cell that is plane by nine samples is halved four times more for that proof; then, as
// at singular points, twice what the samples say is taken.
//
// scallop  mm: allowed height of uncut stock
std::vector<WallFacet> vertical_faces(const std::vector<nurbs::Surface>& surfaces,
                                      const GougeFreePathFitter& path_fitter,
                                      const ScallopAtPoint& places,
                                      double scallop);

}  // namespace cusp::finishing
