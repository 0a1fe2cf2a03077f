// Feeds by load: F words that follow the engagement which the tool meets along the planned program.
#pragma once

#include <functional>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

// mm/min at an engagement of `degrees`, between the limits of the operation. Below 90 degrees the
// chip is thinner than the feed of a tooth, by the sine of the engagement; a straight cut of width w
// with diameter D has 1 / sqrt(1 - (1 - 2 w / D)^2) times the feed. Above 90 degrees the feed falls
// in a straight line to half in a slot.
double feed_by_load(double feed, double degrees, const job::ChipLoad& limits);

// True if an operation has chip_load, or, where there are statistics to write, max_engagement.
bool wants_engagement(const job::Job& job, bool with_stats);

// Measures the engagement of all paths. Adds air_mm, removed_mm3 and mean_removal_mm3_per_min to
// operations with max_engagement. Sets the feeds of those with chip_load: where stock changes along a
// line or an arc, it is divided. A stretch has the least feed that its engagement asks for, or one
// within 5 % of it that holds already. Descents keep their feed.
//
// rates    for the measures of divided paths
// seconds  sets the times of the plan's operations; called before and after
void put_feeds_by_load(const job::Job& job,
                       const toolpath::MachineRates& rates,
                       Plan& plan,
                       const std::function<void()>& seconds);

}  // namespace cusp::cli
