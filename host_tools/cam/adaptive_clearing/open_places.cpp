// The tool runs along the contours; inside, discs of a lattice overlap.
#include "host_tools/cam/adaptive_clearing/open_places.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::adaptive_clearing {

using offset::Box2d;
using offset::box_of;
using offset::Edge;
using offset::edges_of;
using offset::EdgeTree;
using offset::length;
using offset::point_on;
using offset::Region2d;

namespace {

void sweep_region(SweptArea& swept, const Region2d& open, std::vector<Vec2d>& places)
{
    constexpr double kPlaces = 0.1;      // radii between places
    constexpr double kTolerance = 1e-4;  // radii: of chords
    const std::vector<Edge> edges = edges_of(open);
    if (edges.empty()) {
        return;
    }
    for (const Edge& edge : edges) {
        swept.add(edge, kTolerance * swept.radius());
        const int n =
            std::max(1, static_cast<int>(std::ceil(length(edge) / (kPlaces * swept.radius()))));
        for (int i = 1; i <= n; ++i) {
            places.push_back(point_on(edge, static_cast<double>(i) / n));
        }
    }
    // A point is at most 0.71 radii from a node of the lattice; where that node is outside, a
    // contour is nearer.
    const EdgeTree tree{edges};
    const Box2d box = box_of(open);
    const double pitch = swept.radius();
    for (double y = box.y0; y <= box.y1; y += pitch) {
        for (double x = box.x0; x <= box.x1; x += pitch) {
            if (tree.surrounds({x, y})) {
                swept.add_disc({x, y}, swept.radius());
            }
        }
    }
}

}  // namespace

std::vector<Vec2d> sweep_open(SweptArea& swept, const std::vector<Region2d>& open)
{
    std::vector<Vec2d> places;
    for (const Region2d& region : open) {
        sweep_region(swept, region, places);
    }
    return places;
}

}  // namespace cusp::adaptive_clearing
