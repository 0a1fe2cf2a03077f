// The intersection of models, for parts that are less than each of several bodies.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_model {

// What bounds the body that lies below every one of the models, seen from above: of each surface
// the part that is nowhere higher than the other models. A model is the union of its surfaces; it
// has no body where none of them lies, seen from above, but is 2e-4 mm wider, so that bodies may
// share an edge.
//
// Source: Elber & Cohen 1993, section 3: the offset of an intersection is free of concave corners,
// and what the offsets of both leave is what the offset of the trimmed surfaces leaves.
//
// Returns surfaces with trims, whole ones as they were. Sides of new trims lie within `edge_error`
// (mm) of the line where the models meet, as probed at their middles; pieces narrower than half a
// millimetre, or than a 128th of a surface longer than 64 mm, may be missed.
std::vector<nurbs::Surface> intersection_of(const std::vector<std::vector<nurbs::Surface>>& models,
                                            double edge_error = 1e-4);

}  // namespace cusp::part_model
