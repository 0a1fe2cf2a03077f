// Passes of bounded engagement in one level of waterline roughing.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/adaptive_isocurve/rest_regions.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_rougher.hpp"

namespace cusp::adaptive_isocurve {

struct AdaptiveLevelSettings {
    offset::Box2d field;    // limits of the axis
    double wall_clearance;  // mm: from the contours of the slice
    double scallop_height;  // mm: that may stay between passes
    double chord;           // mm: tolerance of arcs written as lines
};

// Passes where the stock and the cutters before have left something of the level.
//
// The bound is that of the circle that the cutter clears to the scallop height. Larger circles of
// the same cutter, higher up, have no more of their circumference in stock: where a place on the
// small circle is within its radius of an earlier place of the axis, the place on the large circle
// in the same direction is within that one's.
adaptive_clearing::AdaptivePath adaptive_level(const RoughWork& work,
                                               const offset::Region2d& slice,
                                               const toolpath::Tool& tool,
                                               const AdaptiveLevelSettings& settings,
                                               const std::vector<ClearedPlaces>& before);

}  // namespace cusp::adaptive_isocurve
