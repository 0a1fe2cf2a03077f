// The cut of a straight move of the tip.
#pragma once

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// A straight part of a path of the tip.
struct TipSegment {
    Vec3d start;
    Vec3d end;
};

// z, mm: how low the tool, moved along the segment, cuts at the plan position; kUnbounded if it
// does not reach the position, or quickly if it cuts no lower than `below`.
double cut_over(const toolpath::Tool& tool,
                const TipSegment& segment,
                Vec2d at,
                double below = kUnbounded);

}  // namespace cusp::contour_pocket
