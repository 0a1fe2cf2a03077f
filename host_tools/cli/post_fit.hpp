// Fits operations to a job's post before planning, and their bounds after it.
#pragma once

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

// Throws InputError where the post has no words for what the job asks: NURBS, coolant, `blend`.
//
// blend  of the call: the tolerance of corners, 0 for the exact path
void check_post(const job::Job& job, double blend);

// Takes what the post's rounding adds (toolpath::added_rounding) off the tolerances, so that the
// written path holds them. Throws InputError where a tolerance is too small for that.
void leave_room_for_rounding(job::Job& job);

// Adds the rounding to the bounds that the planner computed, and says so in the header.
void add_rounding(const job::Job& job, toolpath::PlannedOperation& operation);

}  // namespace cusp::cli
