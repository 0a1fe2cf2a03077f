// The backward pass: from which speeds the machine can brake for everything that lies ahead.
#pragma once

#include "firmware/planner/path_queue.hpp"

namespace cusp::planner {

// Brings the envelope of the published intervals up to date after more were published: it may stop
// at the end of them. Values only rise, last first, and each is a feasible brake at every instant,
// so the servo tick may read meanwhile. Stops where nothing changes: O(intervals published) at
// worst.
void look_ahead(PathQueue& queue) noexcept;

}  // namespace cusp::planner
