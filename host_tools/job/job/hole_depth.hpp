// Width and depth of a hole that is drilled or bored.
#pragma once

#include <algorithm>

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::job {

// mm: how far beyond a through hole the whole diameter goes.
inline constexpr double kBreakThrough = 0.5;

// z of the tip in `hole`: the job's depth, or that of a model's hole where the job names none. The
// full diameter goes through a hole that is open below; in a blind one the tip goes to its bottom, but
// no blunter one into the cone that the hole ends in.
inline double tip_in_hole(const Prismatic& cut, const Hole& hole, const toolpath::Tool& tool)
{
    if (cut.given_depth || !hole.span) {
        return cut.top - cut.depth;
    }
    const double point = profile_height(tool, tool.radius);
    const double beyond =
        hole.span->through ? kBreakThrough + point : std::min(0.0, point - hole.span->tip);
    return hole.span->bottom - beyond;
}

// mm: a hole with a loop of its own is bored as wide as that, else it is as wide as the drill.
inline double radius_of_hole(const Prismatic& cut, const Hole& hole, const toolpath::Tool& tool)
{
    return cut.loops.empty() ? tool.radius : hole.diameter / 2;
}

}  // namespace cusp::job
