// Repairs rounding and conversion errors in the trimming loops of CAD faces.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// Moves points just outside the domain into it, and joins ends that nearly meet.
void tidy(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

// mm on the surface, of the lines that close a loop.
struct LoopRepair {
    double longest_point{};  // more than rounding where the file is wrong
    double widest_gap{};
};

// Puts lines in (u, v) where a loop is open: after the curves that `point_follows` names, where ends lie at
// the same pole, and where ends lie near each other, at most `gap` mm. An edge that is a point, as at a
// pole or where a fillet runs out, has no length, and its converted parameters are wrong.
LoopRepair bridge_gaps(std::vector<nurbs::Curve>& loop,
                       const std::vector<bool>& point_follows,
                       double gap,
                       const nurbs::Surface& surface);

}  // namespace cusp::import
