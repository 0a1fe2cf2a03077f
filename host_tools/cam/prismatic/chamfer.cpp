// The flank passes through the upper edge moved inward by the width: the tip runs beside the wall.
#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/common_edges.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/cam/prismatic/profile_contours.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::Job;
using job::Operation;
using job::OutputForm;
using job::Prismatic;
using offset::Contour;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::inner_first_tour;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

std::vector<PlannedOperation> plan_chamfer(const Job& job, const Operation& operation)
{
    const Prismatic& cut = *operation.prismatic;
    const toolpath::Tool& tool = operation.tool;
    const double away = tool.tip_radius + job::kChamferTip;
    if (away + cut.width > tool.radius) {
        throw InputError(
            fmt::format("{}width {:g} mm is more than the flank of tool {} cuts, "
                        "{:.4g} mm",
                        operation_text(job, operation), cut.width, tool.number,
                        std::max(0.0, tool.radius - away)));
    }
    const double z = cut.top - (cut.width + job::kChamferTip) / elementary::tan(tool.tip_angle / 2);
    const Region2d centres =
        RegionOffset{opposite(without_common_edges(material_of(cut)).region)}.at(away);
    if (centres.contours.empty()) {
        const Vec2d p = in_plan(cut.loops.front().loop.front().points.front());
        throw InputError(
            fmt::format("{}{}: the tip of tool {} fits nowhere beside the loops, such "
                        "as at x {:.6g} y {:.6g} mm",
                        operation_text(job, operation), cut.file, tool.number, p.x, p.y));
    }
    PlannedOperation planned =
        begun(job, operation, fmt::format("{:g} mm wide, tip at z {:.6g} mm", cut.width, z));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    const bool climb = operation.passes.direction_of_cut == CutDirection::kClimb;
    const EdgeForm form{operation.output != OutputForm::kLines, operation.tolerance.plan / 2,
                        climb};
    std::vector<Vec2d> starts;
    for (const Contour& contour : centres.contours) {
        starts.push_back(contour.front().start);
    }
    for (const std::size_t k :
         inner_first_tour(starts, contours_around(centres.contours), Vec2d{0, 0})) {
        const Contour& contour = centres.contours[k];
        const Contour way = climb ? contour : reversed(contour);
        writer.approach(way.front().start, rapid_end(job, cut.top));
        writer.line(MoveKind::kPlunge, {way.front().start.x, way.front().start.y, z});
        write_edges(way, z, z, form, writer);
    }
    writer.retract();
    count_moves(writer, static_cast<int>(centres.contours.size()), 1, planned);
    planned.stats.gouge_bound_mm = kFit;
    return {planned};
}

}  // namespace cusp::prismatic
