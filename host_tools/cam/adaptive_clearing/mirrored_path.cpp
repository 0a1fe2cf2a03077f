// Arcs turn the other way, and contours are reversed.
#include "host_tools/cam/adaptive_clearing/mirrored_path.hpp"

namespace cusp::adaptive_clearing {

using offset::Contour;
using offset::Edge;
using offset::Region2d;
using offset::reversed;

namespace {

Edge mirrored(const Edge& e)
{
    return {
        {-e.start.x, e.start.y}, {-e.end.x, e.end.y}, {-e.centre.x, e.centre.y}, e.radius, -e.turn};
}

}  // namespace

Region2d mirrored(const Region2d& region)
{
    Region2d result;
    for (const Contour& contour : region.contours) {
        Contour other;
        for (const Edge& edge : contour) {
            other.push_back(mirrored(edge));
        }
        result.contours.push_back(reversed(other));
    }
    return result;
}

void mirror(AdaptivePath& path)
{
    for (AdaptiveRun& run : path.runs) {
        for (Edge& edge : run.path) {
            edge = mirrored(edge);
        }
        for (LinkLeg& leg : run.link) {
            leg.end.x = -leg.end.x;
        }
        if (run.helix) {
            run.helix->centre.x = -run.helix->centre.x;
        }
    }
    for (OverEngagement& over : path.over) {
        over.at.x = -over.at.x;
    }
    for (Vec2d& place : path.left) {
        place.x = -place.x;
    }
}

}  // namespace cusp::adaptive_clearing
