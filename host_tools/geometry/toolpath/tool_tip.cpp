// Balls go over into flanks where both have one tangent.
#include "host_tools/geometry/toolpath/tool_tip.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::toolpath {

double radius_at_height(const Tool& tool, double height)
{
    const double corner = tool.corner_radius;
    const double half = is_conical(tool) ? tool.tip_angle / 2 : 0.0;
    const double joined = corner * (1 - elementary::sin(half));
    if (is_conical(tool) && height >= joined) {
        return std::min(tool.radius, flat_radius(tool) + corner * elementary::cos(half) +
                                         (height - joined) * elementary::tan(half));
    }
    const double below = std::max(0.0, corner - height);
    return flat_radius(tool) + std::sqrt(std::max(0.0, corner * corner - below * below));
}

double end_height(const Tool& tool) { return profile_height(tool, tool.radius); }

Tool tip_of(const Tool& tool)
{
    constexpr double kSharp = 1e-3;  // mm
    if (!is_conical(tool)) {
        return tool;
    }
    Tool tip = tool;
    const bool flat = tool.tip_radius > 0;
    tip.shape = flat ? ToolShape::kFlat : ToolShape::kBall;
    tip.radius = flat ? tool.tip_radius : std::max(kSharp, tool.corner_radius);
    tip.corner_radius = flat ? 0.0 : tip.radius;
    tip.tip_angle = tip.tip_radius = 0;
    return tip;
}

}  // namespace cusp::toolpath
