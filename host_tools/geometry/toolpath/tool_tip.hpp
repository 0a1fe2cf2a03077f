// The end of a tool by its height, and what a tool does near its tip alone.
#pragma once

#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::toolpath {

// mm: the radius at a height over the tip, up to the tool's; the inverse of profile_height().
//
// height  mm, >= 0
double radius_at_height(const Tool& tool, double height);

// mm over the tip, at which the end has the tool's radius.
double end_height(const Tool& tool);

// The end without its flanks: the ball of a ball-ended taper, the flat of a vee or a taper, for a sharp tip a
// ball of 0.001 mm radius; other tools as they are.
Tool tip_of(const Tool& tool);

}  // namespace cusp::toolpath
