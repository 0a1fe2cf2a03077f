// Drill cycles as single moves, hole by hole.
#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/hole_tour.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/toolpath/peck_moves.hpp"
#include "host_tools/job/job/hole_depth.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::Job;
using job::Operation;
using job::Prismatic;
using job::tip_in_hole;
using toolpath::DrillCycle;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

std::vector<PlannedOperation> plan_drill(const Job& job, const Operation& operation)
{
    const Prismatic& cut = *operation.prismatic;
    PlannedOperation planned =
        begun(job, operation,
              fmt::format("{}, {:.6g} mm deep", counted(cut.holes.size(), "hole"), cut.depth));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    const double above = rapid_end(job, cut.top);
    const double peck = cut.peck.value_or(2 * cut.depth);
    planned.path.cycle = DrillCycle{above, cut.peck && *cut.peck < cut.depth ? *cut.peck : 0.0};
    double way = 0;
    Vec2d at{0, 0};
    for (const std::size_t k : hole_tour(cut.holes)) {
        const double bottom = tip_in_hole(cut, cut.holes[k], operation.tool);
        writer.approach(cut.holes[k].at, above);
        write_pecks({above, cut.top, bottom}, peck, writer);
        way += norm(cut.holes[k].at - at);
        at = cut.holes[k].at;
    }
    writer.retract();
    count_moves(writer, static_cast<int>(cut.holes.size()), 1, planned);
    planned.stats.counts.emplace_back("holes", static_cast<double>(cut.holes.size()));
    planned.stats.counts.emplace_back("way_mm", way);
    warn_of_narrower_holes(operation, planned);
    return {planned};
}

}  // namespace cusp::prismatic
