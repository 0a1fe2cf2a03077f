// What of a cutter's passes on a level is still to be cut where others were before.
#pragma once

#include <vector>

#include "host_tools/clearing/layer_toolpath_writer.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::adaptive_isocurve {

// Where a cutter has been on the level: the places of its axis, and how far outside them (negative:
// inside) another finds nothing, by rest_offset_between_tools().
struct ClearedPlaces {
    const offset::RegionOffset* region;
    double rest_offset;  // mm
};

// The parts of the runs that leave the places where nothing is left, to some micrometres and never
// less; short ways between two of them are kept, too. radius: of the cutter, mm.
std::vector<clearing::LayerRun> rest_regions(const std::vector<clearing::LayerRun>& runs,
                                             double radius,
                                             const std::vector<ClearedPlaces>& before);

}  // namespace cusp::adaptive_isocurve
