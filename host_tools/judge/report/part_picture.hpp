// A part in plan, as SVG.
#pragma once

#include <string>

#include "host_tools/job/part_info/part_info.hpp"

namespace cusp::report {

// Surfaces and meshes: heights by colour, lit from the upper left, with a scale; marks at the
// steepest point apart from walls, the point that limits the ball, and an undercut. Drawings: loops
// filled by depth and numbered in each layer, open chains in red with their ends.
//
// info  with its surfaces or triangles
std::string part_picture(const part_info::PartInfo& info);

}  // namespace cusp::report
