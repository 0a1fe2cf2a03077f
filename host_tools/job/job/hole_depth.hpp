// Depth to which the tip of a tool goes into a hole.
#pragma once

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::job {

// mm: how far beyond a through hole the whole diameter goes.
inline constexpr double kBreakThrough = 0.5;

// z of the tip in `hole`: the job's depth, or that of a model's hole where the job names none. The
// full diameter goes through a hole that is open below; in a blind one the tip goes to its bottom.
inline double tip_in_hole(const Prismatic& cut, const Hole& hole, const toolpath::Tool& tool)
{
    if (cut.given_depth || !hole.span) {
        return cut.top - cut.depth;
    }
    const double beyond =
        hole.span->through ? kBreakThrough + profile_height(tool, tool.radius) : 0.0;
    return hole.span->bottom - beyond;
}

}  // namespace cusp::job
