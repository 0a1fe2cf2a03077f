// Retract, rapid and entry, or a link over stock already cut.
#include "host_tools/cam/grid_pocket/run_entry.hpp"

#include <algorithm>

namespace cusp::grid_pocket {

using toolpath::kRapidClearance;
using toolpath::MoveKind;
using toolpath::ToolpathWriter;

std::vector<Vec3d> run_beginning(const ClPathFitter& floor,
                                 const std::vector<Vec2d>& corners,
                                 double tool_radius)
{
    constexpr double kRampLength = 4.0;  // radii
    return floor.chords(corners, kRampLength * tool_radius);
}

void enter_run(ToolpathWriter& writer,
               const std::vector<Vec3d>& run,
               double stock_top,
               bool link,
               const ToolpathWriter::HelixFloor& floor)
{
    const Vec3d start = run.front();
    const double over = std::max(stock_top, start.z) + kRapidClearance;
    if (link && over < writer.clearance_z()) {
        writer.line(MoveKind::kLink, {writer.at().x, writer.at().y, over});
        writer.line(MoveKind::kLink, {start.x, start.y, over});
    } else {
        writer.approach(in_plan(start), over);
    }
    writer.enter(run, stock_top, floor);
}

}  // namespace cusp::grid_pocket
