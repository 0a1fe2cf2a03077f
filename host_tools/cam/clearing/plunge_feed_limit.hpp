// Limits the feed of cuts and links that descend into stock: over cliffs, down steep slopes.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::clearing {

// Converts cuts and links into stock to MoveKind::kPlungingCut if at the feed they would descend
// faster than the plunge feed: vertical ones from slightly above the stock on, others as a whole.
// Stock less deep than a twentieth of the tool's radius does not count: scallops between passes.
// Tests: `moves_property_test` and `plunge_feed_limit_test`.
//
// operations  in the order to cut, in the stock of `job`
// box         all places that their axes may reach
void limit_plunge_feed(std::vector<toolpath::PlannedOperation>& operations,
                       const job::Job& job,
                       const offset::Box2d& box);

}  // namespace cusp::clearing
