// Drill cycles as single moves, hole by hole.
#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/toolpath/peck_moves.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"
#include "host_tools/job/job/hole_depth.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::Hole;
using job::Job;
using job::Operation;
using job::Prismatic;
using job::tip_in_hole;
using toolpath::DrillCycle;
using toolpath::PlannedOperation;
using toolpath::short_tour;
using toolpath::ToolpathWriter;

namespace {

// A sentence for each of the first few, and the number of the others.
void warn_of_narrower_holes(const Operation& operation, PlannedOperation& planned)
{
    constexpr std::size_t kNamed = 10;
    const std::vector<Hole>& holes = operation.prismatic->narrower_holes;
    for (std::size_t k = 0; k < std::min(kNamed, holes.size()); ++k) {
        planned.stats.warnings.push_back(fmt::format(
            "{}: the hole of {:g} mm at x {:.6g} y {:.6g} mm is narrower than tool {} of {:g} mm: "
            "left out",
            operation.prismatic->file, holes[k].diameter, holes[k].at.x, holes[k].at.y,
            operation.tool.number, 2 * operation.tool.radius));
    }
    if (holes.size() > kNamed) {
        planned.stats.warnings.push_back(fmt::format("{} more are narrower than the tool: left out",
                                                     counted(holes.size() - kNamed, "hole")));
    }
}

}  // namespace

std::vector<PlannedOperation> plan_drill(const Job& job, const Operation& operation)
{
    const Prismatic& cut = *operation.prismatic;
    std::vector<Vec2d> places;
    for (const Hole& hole : cut.holes) {
        places.push_back(hole.at);
    }
    PlannedOperation planned =
        begun(job, operation,
              fmt::format("{}, {:.6g} mm deep", counted(places.size(), "hole"), cut.depth));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    const double above = rapid_end(job, cut.top);
    const double peck = cut.peck.value_or(2 * cut.depth);
    planned.path.cycle = DrillCycle{above, cut.peck && *cut.peck < cut.depth ? *cut.peck : 0.0};
    double way = 0;
    Vec2d at{0, 0};
    for (const std::size_t k : short_tour(places, at)) {
        const double bottom = tip_in_hole(cut, cut.holes[k], operation.tool);
        writer.approach(places[k], above);
        write_pecks({above, cut.top, bottom}, peck, writer);
        way += norm(places[k] - at);
        at = places[k];
    }
    writer.retract();
    count_moves(writer, static_cast<int>(places.size()), 1, planned);
    planned.stats.counts.emplace_back("holes", static_cast<double>(places.size()));
    planned.stats.counts.emplace_back("way_mm", way);
    warn_of_narrower_holes(operation, planned);
    return {planned};
}

}  // namespace cusp::prismatic
