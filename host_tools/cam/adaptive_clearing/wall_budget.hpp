// Stock that may stay beside walls, shared out between chords of arcs and slivers that no pass goes for.
//
//     const WallShares shares = shares_of(room, radius);  // mm: no more than `room` stays beside a wall
//
// Chords of arcs and the discs of SweptArea leave a sliver beside a path; no pass goes for stock as thin as that, nor
// for what is open by less than barely_open() beyond it.
#pragma once

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"

namespace cusp::adaptive_clearing {

struct WallShares {
    double chords;  // mm, of arcs; not above 0: the tool is too large for the room
    double sliver;  // mm: no pass goes for thinner stock
};

// mm: the width that a path of chords within `chords` (mm) may miss, as SweptArea has it.
double missed_beside(double chords, double radius);

// Radians of the circle: less, beside a sliver (mm), is no stock. It is as thick as a quarter of the sliver at most.
double barely_open(double sliver, double radius);

// Chords of at most 0.005 radii, for which the bound of SweptArea has room.
//
// room    mm, that the sliver and what is barely open have together
// beside  chords count twice: the path keeps as far away from walls as they may bulge to them
WallShares shares_of(double room, double radius, bool beside = false);

// mm: no pass goes for thinner stock; at least the width that the swept area, made of discs and chords, misses.
double least_sliver(const AdaptiveSettings& settings);

// mm: the least room that has chords of `chords` (mm).
double room_for(double chords, double radius);

}  // namespace cusp::adaptive_clearing
