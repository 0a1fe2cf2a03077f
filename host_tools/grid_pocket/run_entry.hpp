// Ways to the start of a run over the floor.
#pragma once

#include <vector>

#include "host_tools/grid_pocket/cl_path_fitter.hpp"
#include "host_tools/toolpath/toolpath_writer.hpp"

namespace cusp::grid_pocket {

// The beginning of a run that a ramp may go along, at the floor's height.
std::vector<Vec3d> run_beginning(const ClPathFitter& floor,
                                 const std::vector<Vec2d>& corners,
                                 double tool_radius);

// To the start of a run, given by its beginning, through stock that may begin below `stock_top`
// (z). With `link` the tool gets there 1 mm over that, without a retract.
void enter_run(toolpath::ToolpathWriter& writer,
               const std::vector<Vec3d>& run,
               double stock_top,
               bool link,
               const toolpath::ToolpathWriter::HelixFloor& floor);

}  // namespace cusp::grid_pocket
