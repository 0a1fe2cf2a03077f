// Samples a mesh: on facets by area, at corners and concave edges.
#pragma once

#include <vector>

#include "host_tools/part_info/ground.hpp"
#include "host_tools/part_info/mesh_health.hpp"

namespace cusp::part_info {

// Some 100 000 places: large facets have several; of very many small ones only some have one.
std::vector<GroundPlace> facet_places(const WeldedMesh& mesh);

// Places where a ball may not reach: concave edges, the sharpest over their width first, then
// corners. At most `most` of each; of more corners an even selection.
std::vector<GroundPlace> crease_places(const WeldedMesh& mesh, std::size_t most);

}  // namespace cusp::part_info
