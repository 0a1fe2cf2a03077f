// The intersection of models: the surfaces of the body common to several bodies.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

// The top of the body that lies below every model: of each surface the part that is nowhere higher
// than the other models. A model is the union of its surfaces. It has no body beside them, but is
// widened by 2e-4 mm so that bodies may share an edge.
//
// Source: Elber & Cohen 1993, section 3. The offset of an intersection has no concave corners; the
// intersection of both offsets is the offset of the trimmed surfaces.
//
// Returns surfaces with trims; whole surfaces are unchanged. New trims lie within `edge_error` (mm)
// of the curve where the models meet, as probed at the middles of sides. Parts narrower than half a
// millimetre, or than a 128th of a surface longer than 64 mm, may be missed.
std::vector<nurbs::Surface> intersection_of(const std::vector<std::vector<nurbs::Surface>>& models,
                                            double edge_error = 1e-4);

}  // namespace cusp::part_model
