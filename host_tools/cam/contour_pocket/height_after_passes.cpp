// The CL points of an edge are computed at the first query near it.
#include "host_tools/cam/contour_pocket/height_after_passes.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::contour_pocket {

using clearing::ClearedRegion;
using clearing::ClearingPass;
using drop_cutter::DropCutter;
using offset::Box2d;
using offset::Edge;
using toolpath::Tool;

namespace {

std::vector<Edge> edges_of(const ClearedRegion& cleared)
{
    std::vector<Edge> edges;
    for (const ClearingPass& pass : cleared.passes) {
        edges.insert(edges.end(), pass.path.begin(), pass.path.end());
    }
    return edges;
}

}  // namespace

HeightAfterPasses::HeightAfterPasses(const ClearedRegion& cleared,
                                     const DropCutter& floor,
                                     double share)
    : floor_{floor},
      apart_{share * floor.tool().radius},
      edges_{edges_of(cleared)},
      tree_{edges_},
      tips_(edges_.size())
{
}

double HeightAfterPasses::height(Vec2d place)
{
    const Tool& tool = floor_.tool();
    const double radius = tool.radius;
    double least = kUnbounded;
    const Box2d box{place.x - radius, place.y - radius, place.x + radius, place.y + radius};
    tree_.visit_meeting(box, [&](std::size_t e) {
        std::vector<Vec3d>& tips = tips_[e];
        if (tips.empty()) {
            const int n = 1 + static_cast<int>(length(edges_[e]) / apart_);
            for (int i = 0; i <= n; ++i) {
                const Vec2d at = point_on(edges_[e], static_cast<double>(i) / n);
                tips.push_back({at.x, at.y, floor_.tip_height(at)});
            }
        }
        for (const Vec3d& tip : tips) {
            const double x = tip.x - place.x;
            const double y = tip.y - place.y;
            const double square = x * x + y * y;
            if (square < radius * radius && tip.z < least) {
                least = std::min(least, tip.z + profile_height(tool, std::sqrt(square)));
            }
        }
    });
    return least;
}

}  // namespace cusp::contour_pocket
