// Cuts off raw offset pieces what lies nearer to the source than the distance, before crossings are
// looked for.
#pragma once

#include "host_tools/offset/edge_tree.hpp"
#include "host_tools/offset/raw_offset.hpp"

namespace cusp::offset {

// The pieces without most of their parts that lie nearer than `distance` (mm) to an edge of the
// source, whose tree is given. Only what is nearer by 1e-5 mm goes, so every place where a piece
// comes out of the rest, and every crossing there, is still to be found; a new end is one that lies
// too near. O(log n) a piece where source edges are spread out.
//
// For regions of many small curves: at a distance of many curve lengths each raw piece crosses as
// many others, nearly all of it in vain.
std::vector<RawPiece> trimmed(const std::vector<RawPiece>& pieces,
                              const EdgeTree& source,
                              double distance);

}  // namespace cusp::offset
