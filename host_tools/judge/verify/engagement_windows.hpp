// Looks again, on finer grids, where the height map finds more engagement than is allowed.
//
// Trochoids advance by less than a pitch of the height map: it reads hundreds of millimetres of
// them over the limit. Windows around such places are cut again by all runs, on a grid of a 150th
// of the tool's radius.
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/engagement_trace.hpp"

namespace cusp::verify {

// Replaces the angles around places over `counts_over` of their run by what the finer grid finds.
// Those that it does not look at keep theirs: the windows with the most way over come first, until
// they hold twice as many positions as all runs together, and no more follow where the first
// confirms 80 % of its way. Thus a program that is over its limit nearly everywhere costs one
// window.
//
// grid     of the height map, with which `found` was found
// spacing  mm between positions
// found    of each run
void look_closer(const job::Job& job,
                 const HeightGrid& grid,
                 double spacing,
                 const std::vector<ToolPositions>& runs,
                 std::vector<EngagementRun>& found);

}  // namespace cusp::verify
