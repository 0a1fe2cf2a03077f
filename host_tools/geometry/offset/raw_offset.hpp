// The untrimmed offset of contours: one piece for each edge and each corner that opens a gap.
#pragma once

#include <cstdint>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

struct RawPiece {
    Edge edge;
    bool joined;             // its end is the start of the next piece
    bool last;               // the next piece of this contour is its first one
    std::uint32_t origin{};  // identifies the piece at any distance; < kOrigins * number of edges
};

// Pieces per source edge: its own, and two halves of the corner behind it.
constexpr std::uint32_t kOrigins = 3;

// Pieces of all contours, contour by contour, `distance` (mm, > 0) to the left of the source. Arcs
// that the offset would turn inside out are left out: all of their points are nearer to the source
// arc than `distance`.
std::vector<RawPiece> raw_offset(const Region2d& source, double distance);

// The pieces of which a part may be left at this distance, with their joints. The farther inward a
// point of an edge moves, the more other edges are nearer than its own: what vanished stays so.
//
// gone  for each origin the distance, mm, from which on nothing of its piece is left
std::vector<RawPiece> living_pieces(std::vector<RawPiece> pieces,
                                    const std::vector<double>& gone,
                                    double distance);

}  // namespace cusp::offset
