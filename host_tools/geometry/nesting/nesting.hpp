// Places pieces on a sheet: the same outline many times, or several, none nearer to another than a gap.
//
//   const nesting::Piece bracket{{outline}, 12};              // closed polylines and open ones, mm
//   const auto places = nesting::nest({bracket}, {{600, 400}, 8.0});
//   places[0].size();                                        // 12, or as many as there is room for
//
// Pieces are turned by quarter turns and set one after the other, the largest first, as near to the sheet's lower edge as
// there is room: in squares of 1/512 of the sheet's longer side, which count as full where an outline touches them. Pieces
// of one kind may lie in straight rows of their boxes instead, exact to the last bit, where that places more or takes less
// of the sheet.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::nesting {

using Polyline = std::vector<Vec2d>;

// All within the outermost polylines belongs to the piece, holes too.
struct Piece {
    std::vector<Polyline> polylines;  // mm; a closed one ends where it begins; not all empty
    int count{1};                     // >= 1
};

// From x = 0, y = 0.
struct Sheet {
    Vec2d size;    // mm, > 0
    double gap{};  // mm, >= 0: from piece to piece, and to the sheet's edges
};

// The piece is turned about x = 0, y = 0, then moved.
struct Place {
    double degrees{};  // 0, 90, 180 or 270
    Vec2d move;        // mm
};

// The list of each piece has as many places as its count, or fewer if the sheet is full. They are the same on every machine.
std::vector<std::vector<Place>> nest(const std::vector<Piece>& pieces, const Sheet& sheet);

// `p` turned by a multiple of a quarter turn, exact.
Vec2d quarter_turned(Vec2d p, double degrees);

}  // namespace cusp::nesting
