// Ways along the middle of necks and slots: where two walls stand opposite each other, so near that
// a tool between them has hardly room to turn.
//
//     for (const NeckWay& way : neck_ways(walls, {3.01, 0.06, 1.0, 1.8, 0.3})) {
//         way.front().centre;    // as far from the one wall as from the other
//         way.front().room;      // mm: the tool's centre may be so far from there
//     }
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_clearing {

struct NeckPlace {
    Vec2d centre;
    double room;  // mm: radius of the circle that the tool's centre has
};

using NeckWay = std::vector<NeckPlace>;

struct NeckLimits {
    double wall_clearance;    // mm: of the tool's centre
    double least_room;        // mm, > 0: narrower necks are none, but ends go on into corners
    double most_room;         // mm: nor are wider ones
    double most_room_beside;  // mm, > most_room: in the mouths of necks
    double pitch;             // mm, most: of places along the walls
};

// Each neck is found from each of its walls, with its mouths and the square corners at its ends.
// Corners alone are none: there a circle that touches both walls does so at places less than 5/6 of
// a half turn apart.
std::vector<NeckWay> neck_ways(const offset::RegionOffset& walls, const NeckLimits& limits);

// mm, at most `most`: between the two walls that the place lies between; none where they are farther
// apart or make a corner.
std::optional<double> slot_width(const offset::RegionOffset& walls, Vec2d place, double most);

}  // namespace cusp::adaptive_clearing
