// The lower side of a tool.
#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/toolpath/tool.hpp"

namespace cusp::toolpath {

const char* name_of(ToolShape shape)
{
    return shape == ToolShape::kBall ? "ball" : shape == ToolShape::kFlat ? "flat" : "bull";
}

double profile_height(const Tool& tool, double d)
{
    if (!(d <= tool.radius)) {
        return std::numeric_limits<double>::infinity();
    }
    const double beyond_flat = d - (tool.radius - tool.corner_radius);
    if (beyond_flat <= 0) {
        return 0.0;
    }
    const double corner = tool.corner_radius;
    return corner - std::sqrt(std::max(0.0, corner * corner - beyond_flat * beyond_flat));
}

}  // namespace cusp::toolpath
