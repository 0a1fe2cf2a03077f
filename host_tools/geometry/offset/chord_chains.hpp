// Edges as chains of segments on the grid that meet as the edges do.
#pragma once

#include "host_tools/geometry/offset/planar_segments.hpp"

namespace cusp::offset {

// A chain for each edge, from its start to its end; Segment::source is the edge's index. Edges are
// cut where they meet, and at vertices within kSameVertex, which they are led through. Arcs are
// halved until nothing else comes between an arc and its chord, or the chord is within 1e-6 mm.
std::vector<Segment> chord_chains(const std::vector<Edge>& edges, GridPoints& points);

}  // namespace cusp::offset
