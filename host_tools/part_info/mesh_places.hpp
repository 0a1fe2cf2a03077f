// A mesh as places to look at: on its facets by area, at its corners and concave edges.
#pragma once

#include <vector>

#include "host_tools/part_info/ground.hpp"
#include "host_tools/part_info/mesh_health.hpp"

namespace cusp::part_info {

// Some 100 000 places: large facets have several, of very many small ones some stand for others.
std::vector<GroundPlace> facet_places(const WeldedMesh& mesh);

// Where a ball may not reach: concave edges, those that turn most over the way across them first,
// in that order, then corners. At most `most` of each; of more corners every so many.
std::vector<GroundPlace> crease_places(const WeldedMesh& mesh, std::size_t most);

}  // namespace cusp::part_info
