// What a straight move of the tip cuts.
#pragma once

#include "host_tools/offset/contour.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// A straight piece of a path of the tip.
struct TipSegment {
    Vec3d start;
    Vec3d end;
};

// How low the tool, moved along the segment, cuts over the plan position: z, mm; kUnbounded where
// it does not get there, or where it is known soon that it is not lower than `below`.
double cut_over(const toolpath::Tool& tool,
                const TipSegment& segment,
                Vec2d at,
                double below = kUnbounded);

}  // namespace cusp::contour_pocket
