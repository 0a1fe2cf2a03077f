// A region cleared for climb milling, its parts widened in one of two ways.
#pragma once

#include "host_tools/adaptive_clearing/adaptive_clearing.hpp"

namespace cusp::adaptive_clearing {

// The way out of the hole at the foot of an entry.
enum class Widening {
    kSteered,
    kSpiral,  // to the walls, in round parts
};

struct PlannedRegion {
    AdaptivePath path;
    bool is_round;  // a part that is entered by a helix fills most of its greatest circle
};

// For climb milling, whatever the direction of the settings.
PlannedRegion plan_region(const offset::Region2d& region,
                          const AdaptiveSettings& settings,
                          Widening widening);

}  // namespace cusp::adaptive_clearing
