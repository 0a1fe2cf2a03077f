// A part in plan, as SVG.
#pragma once

#include <string>

#include "host_tools/part_info/part_info.hpp"

namespace cusp::report {

// Surfaces and meshes: heights by colour, lit from the upper left, with a scale; marked are the
// steepest place apart from walls, the place that bounds the ball, and an undercut. Drawings: loops
// filled by their depth and numbered layer by layer, open chains in red with their ends.
//
// info  still holding its surfaces or triangles
std::string part_picture(const part_info::PartInfo& info);

}  // namespace cusp::report
