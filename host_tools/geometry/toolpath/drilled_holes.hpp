// The holes of a path that does nothing but drill.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

struct DrilledHole {
    Vec3d bottom;  // of the tip
    double above;  // z: where the first move at feed begins
    double feed;   // mm/min
};

// In the order of the path; the pecks of one place are one hole.
std::vector<DrilledHole> drilled_holes(const Toolpath& path);

}  // namespace cusp::toolpath
