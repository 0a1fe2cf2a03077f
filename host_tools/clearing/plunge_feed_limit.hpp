// Limits the feed of cuts and links that go down into stock: over cliffs, down steep slopes.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/offset/contour.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::clearing {

// Cuts and links that go down so steeply that at the feed they would go down faster than at the
// plunge feed become descents where that is into metal: upright ones from a little over it on,
// others as a whole. Metal no deeper than a twentieth of the tool's radius does not count: ridges
// that passes leave each other. `moves_property_test` and `plunge_feed_limit_test` judge it.
//
// operations  in the order to cut, in the stock of `job`
// box         all places that their axes may reach
void limit_plunge_feed(std::vector<toolpath::PlannedOperation>& operations,
                       const job::Job& job,
                       const offset::Box2d& box);

}  // namespace cusp::clearing
