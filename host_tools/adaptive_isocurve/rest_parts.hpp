// What of a cutter's passes on a level is still to be cut where others were before.
#pragma once

#include <vector>

#include "host_tools/clearing/level_moves.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::host {

// Where a cutter has been on the level: the places of its axis, and how far outside them (negative:
// inside) another finds nothing, by nested_reach().
struct ClearedPlaces {
    const RegionOffset* region;
    double nested;  // mm
};

// The parts of the runs that leave the places where nothing is left, to some micrometres and never
// less; short ways between two of them are kept, too. radius: of the cutter, mm.
std::vector<LevelRun> rest_parts(const std::vector<LevelRun>& runs,
                                 double radius,
                                 const std::vector<ClearedPlaces>& before);

}  // namespace cusp::host
