// Samples a mesh on facets, by area, at corners and at concave edges.
#pragma once

#include <vector>

#include "host_tools/job/part_info/ground.hpp"
#include "host_tools/job/part_info/mesh_health.hpp"

namespace cusp::part_info {

// Some 100 000 points: several on large facets; where facets are very many, on some of them only.
std::vector<GroundPlace> facet_places(const WeldedMesh& mesh);

// Points that a ball may not reach: concave edges, the sharpest relative to their width first, then
// corners. At most `max_count` of each; corners are selected evenly.
std::vector<GroundPlace> crease_places(const WeldedMesh& mesh, std::size_t max_count);

}  // namespace cusp::part_info
