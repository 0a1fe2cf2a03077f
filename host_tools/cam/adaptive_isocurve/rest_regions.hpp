// Rest machining: the parts of a cutter's passes on a level that earlier cutters have left.
#pragma once

#include <vector>

#include "host_tools/cam/clearing/layer_toolpath_writer.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_isocurve {

// The region of a cutter's axis on the level, and how far outside it (negative: inside) another
// cutter finds no stock, by rest_offset_between_tools().
struct ClearedPlaces {
    const offset::RegionOffset* region;
    double rest_offset;  // mm
};

// The parts of the runs outside the cleared places, to some micrometres and never less. Short gaps
// between two parts are kept as well.
//
// radius  mm, of the cutter
std::vector<clearing::LayerRun> rest_regions(const std::vector<clearing::LayerRun>& runs,
                                             double radius,
                                             const std::vector<ClearedPlaces>& before);

}  // namespace cusp::adaptive_isocurve
