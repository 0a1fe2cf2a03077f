// The feed at an engagement.
#pragma once

#include "host_tools/job/job/job.hpp"

namespace cusp::plan {

// mm/min at an engagement of `degrees`, between the limits of the operation. Below 90 degrees the
// chip is thinner than the feed of a tooth, by the sine of the engagement; a straight cut of width w
// with diameter D has 1 / sqrt(1 - (1 - 2 w / D)^2) times the feed. Above 90 degrees the feed falls
// in a straight line to half in a slot.
double feed_by_load(double feed, double degrees, const job::ChipLoad& limits);

}  // namespace cusp::plan
