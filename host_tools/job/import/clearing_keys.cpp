// Angles and feeds of roughing.
#include "host_tools/job/import/clearing_keys.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "firmware/base/math.hpp"
#include "host_tools/job/import/number_ranges.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Operation;

namespace {

constexpr double kDefaultEngagement = 60;  // degrees

}  // namespace

void read_clearing(JobTable& table, Operation& operation)
{
    constexpr Range kEngagement{20, 150};
    const bool pocket = operation.strategy == "contour_pocket" || operation.strategy == "pocket";
    const bool hull = operation.strategy == "hull_rough";
    const auto clearing = hull ? table.one_of("clearing", {"zigzag", "contour", "adaptive"})
                               : table.one_of("clearing", {"contour", "adaptive"});
    operation.contour_clearing = clearing == "contour";
    const auto engagement = table.number("max_engagement", kEngagement);
    if (clearing == "adaptive") {
        operation.max_engagement = engagement.value_or(kDefaultEngagement);
        const double radius = operation.tool.radius;
        // Elsewhere a step over is that of the finish.
        if (pocket && operation.step_over && *operation.step_over < radius) {
            // A straight cut of this width has this angle.
            operation.max_engagement =
                std::min(*operation.max_engagement,
                         std::acos(1.0 - *operation.step_over / radius) * 180.0 / kPi);
        }
        if (*operation.max_engagement < kEngagement.low) {
            table.refuse("step_over",
                         fmt::format("is {:g} mm, {:.1f} degrees of engagement for a tool of "
                                     "radius {:g} mm; the least is {:g}",
                                     *operation.step_over, *operation.max_engagement, radius,
                                     kEngagement.low));
        }
    } else if (engagement) {
        table.refuse("max_engagement", "needs clearing = \"adaptive\"");
    }
}

void read_chip_load(JobTable& table, double unit, Operation& operation)
{
    const bool wanted = table.flag("chip_load").value_or(false);
    const auto rate = [&](const char* key) {
        auto value = table.number(key, kFeed);
        if (value) {
            *value *= unit;
        }
        return value;
    };
    const job::ChipLoad load{rate("feed_min"), rate("feed_max")};
    for (const char* key : {"feed_min", "feed_max"}) {
        if (!wanted && (std::string_view{key} == "feed_min" ? load.feed_min : load.feed_max)) {
            table.refuse(key, "needs chip_load = true");
        }
    }
    if (!wanted) {
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
    operation.chip_load = load;
}

}  // namespace cusp::import
