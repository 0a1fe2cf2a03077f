// Drill cycles as single moves: each peck goes a step deeper, then rapid moves up and down clear the
// chips.
#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
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
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::short_tour;
using toolpath::ToolpathWriter;

namespace {

// mm: as the controller's own G83, rapid moves back into the hole end above the last depth.
constexpr double kPeckClearance = 0.254;

// Heights of a hole, z.
struct HoleHeights {
    double above;  // rapid moves end here
    double top;
    double bottom;
};

void drill_hole(Vec2d at, const HoleHeights& hole, double peck, ToolpathWriter& writer)
{
    writer.approach(at, hole.above);
    for (double z = hole.top; z > hole.bottom;) {
        // a last peck thinner than a thousandth of the others is none
        z = z - peck - peck / 1000 > hole.bottom ? z - peck : hole.bottom;
        writer.line(MoveKind::kPlunge, {at.x, at.y, z});
        if (z > hole.bottom) {
            writer.line(MoveKind::kRapid, {at.x, at.y, hole.above});
            writer.line(MoveKind::kRapid, {at.x, at.y, std::min(z + kPeckClearance, hole.above)});
        }
    }
}

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
        drill_hole(places[k], {above, cut.top, bottom}, peck, writer);
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
