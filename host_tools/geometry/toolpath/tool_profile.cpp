// The lower side of a tool.
#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::toolpath {

const char* name_of(ToolShape shape)
{
    switch (shape) {
        case ToolShape::kBall:
            return "ball";
        case ToolShape::kFlat:
            return "flat";
        case ToolShape::kBull:
            return "bull";
        case ToolShape::kVee:
            return "vee";
        case ToolShape::kDrill:
            return "drill";
        case ToolShape::kTaper:
            return "taper";
    }
    return "";
}

bool is_conical(const Tool& tool)
{
    return tool.shape == ToolShape::kVee || tool.shape == ToolShape::kDrill ||
           tool.shape == ToolShape::kTaper;
}

double flat_radius(const Tool& tool)
{
    return is_conical(tool) ? tool.tip_radius : tool.radius - tool.corner_radius;
}

double least_radius(const std::vector<Tool>& tools)
{
    double least = kInfinite;
    for (const Tool& tool : tools) {
        least = std::min(least, tool.radius);
    }
    return least;
}

double profile_height(const Tool& tool, double d)
{
    if (!(d <= tool.radius)) {
        return kInfinite;
    }
    const double beyond_flat = d - flat_radius(tool);
    if (beyond_flat <= 0) {
        return 0.0;
    }
    const double corner = tool.corner_radius;
    if (is_conical(tool)) {
        const double half = tool.tip_angle / 2;
        const double on_flank = beyond_flat - corner * elementary::cos(half);
        if (on_flank >= 0) {
            return corner * (1 - elementary::sin(half)) + on_flank / elementary::tan(half);
        }
    }
    return corner - std::sqrt(std::max(0.0, corner * corner - beyond_flat * beyond_flat));
}

}  // namespace cusp::toolpath
