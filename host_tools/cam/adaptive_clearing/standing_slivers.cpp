// A sliver is known by points of it, at most a few hundredths of the radius apart.
#include "host_tools/cam/adaptive_clearing/standing_slivers.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/geometry/offset/region_overlay.hpp"

namespace cusp::adaptive_clearing {

using offset::Contour;
using offset::grown;
using offset::line_edge;
using offset::Region2d;
using offset::without;

namespace {

constexpr double kReach = 1.1;  // radii: within it a tool may meet the sliver around a point

}  // namespace

void StandingSlivers::add(const AdaptivePath& path, double tool_radius, double above)
{
    std::vector<Sliver> more;
    for (const Vec2d at : path.left) {
        more.push_back({at, top_at(at, tool_radius, above)});
    }
    slivers_.insert(slivers_.end(), more.begin(), more.end());
}

double StandingSlivers::top_at(Vec2d place, double tool_radius, double above) const
{
    for (const Sliver& sliver : slivers_) {
        if (norm(sliver.at - place) < kReach * tool_radius) {
            above = std::max(above, sliver.top);
        }
    }
    return above;
}

Region2d off_slivers(const Region2d& region, const AdaptivePath& path, double tool_radius)
{
    Region2d beside;
    for (const Vec2d at : path.left) {
        const double half = kReach * tool_radius;
        const Vec2d corners[]{{at.x - half, at.y - half},
                              {at.x + half, at.y - half},
                              {at.x + half, at.y + half},
                              {at.x - half, at.y + half}};
        Contour square;
        for (std::size_t i = 0; i < 4; ++i) {
            square.push_back(line_edge(corners[i], corners[(i + 1) % 4]));
        }
        beside.contours.push_back(std::move(square));
    }
    return beside.contours.empty() ? region : without(region, beside);
}

}  // namespace cusp::adaptive_clearing
