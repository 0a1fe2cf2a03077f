// Trims parts of raw offset pieces that are nearer to the source than the offset distance, before
// the search for crossings.
#pragma once

#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/offset/raw_offset.hpp"

namespace cusp::offset {

// The pieces without most of the parts that are nearer than `distance` (mm) to an edge of the
// source, whose tree is given. Only parts nearer by at least 1e-5 mm are removed. Thus all points
// where a piece becomes valid, and the crossings there, remain; new ends are always too near. O(log
// n) per piece for spread source edges.
//
// This is for regions of many small curves. At a distance of many curve lengths each raw piece
// crosses as many others, nearly all of them without effect.
std::vector<RawPiece> trimmed(const std::vector<RawPiece>& pieces,
                              const EdgeTree& source,
                              double distance);

}  // namespace cusp::offset
