// The lowest cut of a straight move above a place, for each shape of tool end.
#include "host_tools/cam/contour_pocket/tip_segment.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/edge_contact.hpp"

namespace cusp::contour_pocket {

using drop_cutter::drop_on_edge;
using offset::distance;
using toolpath::Tool;

double cut_over(const Tool& tool, const TipSegment& segment, Vec2d at, double below)
{
    const Vec2d a{segment.start.x, segment.start.y};
    const Vec2d move = in_plan(segment.end) - a;
    const double whole = std::sqrt(dot(move, move));
    if (whole < 1e-9) {
        return std::min(segment.start.z, segment.end.z) + profile_height(tool, distance(a, at));
    }
    const Vec2d way = move * (1.0 / whole);
    const double along = dot(at - a, way);
    const double away = std::abs(cross(way, at - a));
    const double lowest = std::min(segment.start.z, segment.end.z);
    if (away >= tool.radius || lowest + profile_height(tool, away) >= below) {
        return kUnbounded;
    }
    const double slope = (segment.end.z - segment.start.z) / whole;
    // The place raises a passing tool like an edge that falls away from it.
    const auto edge = drop_on_edge(tool, {-slope, away, -along, whole - along});
    return edge ? segment.start.z + slope * along - edge->lift : kUnbounded;
}

}  // namespace cusp::contour_pocket
