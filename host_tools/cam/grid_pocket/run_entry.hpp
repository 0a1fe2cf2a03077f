// Moves to the start of a run over the floor.
#pragma once

#include <vector>

#include "host_tools/cam/grid_pocket/cl_path_fitter.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::grid_pocket {

// The first part of a run, at the floor's height, for a ramp along it.
std::vector<Vec3d> run_beginning(const ClPathFitter& floor,
                                 const std::vector<Vec2d>& corners,
                                 double tool_radius);

// To the start of a run, given by its first part, through stock that may begin below `stock_top`
// (z). With `link` the tool moves there 1 mm above that, without a retract.
void enter_run(toolpath::ToolpathWriter& writer,
               const std::vector<Vec3d>& run,
               double stock_top,
               bool link,
               const toolpath::ToolpathWriter::HelixFloor& floor);

}  // namespace cusp::grid_pocket
