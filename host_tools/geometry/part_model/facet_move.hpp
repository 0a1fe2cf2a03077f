// The least distance of a tool from triangles while it moves straight.
#pragma once

#include "host_tools/geometry/part_model/nearest_search.hpp"

namespace cusp::part_model {

// mm: a lower bound of the distance between the core, moved straight by `way`, and the facets of a
// mesh.
//
// sufficient  mm: the bound never exceeds this
// resolution  mm: how much too low a bound below that may be
//
// The distance of two convex sets, one moved straight, is convex along the move. So of each facet that
// is near enough two places and the slopes there bound it, and the places between where these bounds
// meet. Boxes are excluded by the part of the move over them.
double least_facet_distance(const PartModel::State& state,
                            const ToolCore& core,
                            Vec3d way,
                            double sufficient,
                            double resolution);

}  // namespace cusp::part_model
