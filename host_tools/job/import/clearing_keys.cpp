// Angles and feeds of roughing.
#include "host_tools/job/import/clearing_keys.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Operation;

void read_clearing(JobTable& table, const job::Strategy& strategy, Operation& operation)
{
    const double engagement = table.number_or_default("max_engagement");
    const double least = table.range_of("max_engagement").low;
    if (table.choice("clearing") == "adaptive") {
        operation.passes.max_engagement = engagement;
        const double radius = operation.tool.radius;
        // Elsewhere a step over is that of the finish.
        if (strategy.traits.pocket && operation.passes.step_over &&
            *operation.passes.step_over < radius) {
            // A straight cut of this width has this angle.
            operation.passes.max_engagement = std::min(
                *operation.passes.max_engagement,
                elementary::acos(1.0 - *operation.passes.step_over / radius) * 180.0 / kPi);
        }
        if (*operation.passes.max_engagement < least) {
            table.refuse("step_over",
                         fmt::format("is {:g} mm, {:.1f} degrees of engagement for a tool of "
                                     "radius {:g} mm; the least is {:g}",
                                     *operation.passes.step_over, *operation.passes.max_engagement,
                                     radius, least));
        }
    }
}

void read_chip_load(JobTable& table, Operation& operation)
{
    const job::ChipLoad load{table.number("feed_min"), table.number("feed_max")};
    if (!table.flag_or_default("chip_load")) {
        return;
    }
    const auto is_flat = [](const toolpath::Tool& tool) {
        return tool.shape == toolpath::ToolShape::kFlat;
    };
    if (!is_flat(operation.tool) &&
        std::none_of(operation.tools.begin(), operation.tools.end(), is_flat)) {
        table.refuse("chip_load",
                     "needs a flat end: the engagement of a round or pointed end changes along it");
    }
    if (load.feed_min && load.feed_max && *load.feed_min > *load.feed_max) {
        table.refuse("feed_min", fmt::format("is {:g} mm/min, above feed_max, {:g} mm/min",
                                             *load.feed_min, *load.feed_max));
    }
    operation.passes.chip_load = load;
}

}  // namespace cusp::import
