// The slice is the region of the axis; beside the stock and in cleared ground passes may start.
#include "host_tools/cam/adaptive_isocurve/waterline_adaptive.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::adaptive_isocurve {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using adaptive_clearing::cleared_radius;
using offset::Box2d;
using offset::Contour;
using offset::line_edge;
using offset::Region2d;
using toolpath::Tool;

namespace {

constexpr double kOffStock = 2e-3;  // mm from the cutter to the stock

Contour rectangle(const Box2d& box)
{
    const Vec2d corners[]{{box.x0, box.y0}, {box.x1, box.y0}, {box.x1, box.y1}, {box.x0, box.y1}};
    Contour out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.push_back(line_edge(corners[i], corners[(i + 1) % 4]));
    }
    return out;
}

}  // namespace

AdaptivePath adaptive_level(const RoughWork& work,
                            const Region2d& slice,
                            const Tool& tool,
                            const AdaptiveLevelSettings& settings,
                            const std::vector<ClearedPlaces>& before)
{
    AdaptiveSettings adaptive;
    adaptive.tool_radius = cleared_radius(tool, settings.scallop_height);
    adaptive.wall_clearance = settings.wall_clearance;
    adaptive.max_engagement = *work.operation.passes.max_engagement * kPi / 180.0;
    adaptive.tolerance = std::min(settings.chord, 0.005 * adaptive.tool_radius);
    adaptive.corner = work.operation.tolerance.plan;
    adaptive.direction = work.operation.passes.direction_of_cut;
    Region2d beside{{rectangle(settings.field)}};
    for (const Contour& hole :
         grown(Region2d{{rectangle(work.stock.plan)}}, tool.radius + kOffStock).contours) {
        beside.contours.push_back(reversed(hole));
    }
    adaptive.open.push_back(std::move(beside));
    for (const ClearedPlaces& other : before) {
        const Region2d& centres = other.region->source();
        if (other.rest_offset > 0.0) {
            adaptive.open.push_back(grown(centres, other.rest_offset));
        } else {
            adaptive.open.push_back(other.rest_offset < 0.0 ? other.region->at(-other.rest_offset)
                                                            : centres);
        }
    }
    return clear_adaptively(slice, adaptive);
}

}  // namespace cusp::adaptive_isocurve
