// A region cleared for climb milling, from its entries on in one of two ways.
#pragma once

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"

namespace cusp::adaptive_clearing {

struct PlannedRegion {
    AdaptivePath path;
    bool is_round;  // a part that is entered by a helix fills most of its greatest circle
};

// For climb milling, whatever the direction of the settings.
//
// spirals  in round parts the first pass is a spiral to the walls; else all passes are steered
PlannedRegion plan_region(const offset::Region2d& region,
                          const AdaptiveSettings& settings,
                          bool spirals);

}  // namespace cusp::adaptive_clearing
