// Loops are sampled at steps of a quarter of the distance.
#include "host_tools/cam/prismatic/profile_contours.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::prismatic {

using job::NestedLoop;
using job::Prismatic;
using offset::area;
using offset::Box2d;
using offset::box_of;
using offset::Contour;
using offset::Edge;
using offset::edges_of;
using offset::EdgeTree;
using offset::fit_contour;
using offset::point_on;
using offset::Region2d;
using offset::reversed;

Region2d material_of(const Prismatic& cut)
{
    Region2d region;
    for (const NestedLoop& loop : cut.loops) {
        Contour contour = fit_contour(loop.loop, kFit);
        if (contour.empty() || !(std::abs(area(contour)) > 0)) {
            throw InputError(loop.name + ": the loop encloses nothing");
        }
        const bool counter_clockwise = area(contour) > 0;
        region.contours.push_back(counter_clockwise == loop.hole ? reversed(contour) : contour);
    }
    return region;
}

Region2d opposite(Region2d region)
{
    for (Contour& contour : region.contours) {
        contour = reversed(contour);
    }
    return region;
}

Unreached unreached(const Region2d& waste, const Region2d& centres, double distance)
{
    constexpr double kApart = 0.25;    // of the distance
    constexpr double kTouches = 0.01;  // of the distance
    Unreached found;
    const EdgeTree tree{edges_of(centres)};
    for (std::size_t n = 0; n < waste.contours.size(); ++n) {
        double stretch = 0;
        bool touched = false;
        for (const Edge& edge : waste.contours[n]) {
            const double size = offset::length(edge);
            const int pieces = 1 + static_cast<int>(size / (kApart * distance));
            for (int i = 0; i < pieces; ++i) {
                const Vec2d p = point_on(edge, (i + 0.5) / pieces);
                if (tree.size() > 0 && tree.any_nearer(p, distance * (1 + kTouches))) {
                    stretch = 0;
                    touched = true;
                    continue;
                }
                stretch += size / pieces;
                found.length += size / pieces;
                if (stretch > found.longest) {
                    found.longest = stretch;
                    found.place = p;
                }
            }
        }
        if (!touched) {
            found.loops.push_back(n);
        }
    }
    return found;
}

std::vector<std::optional<std::size_t>> contours_around(const std::vector<Contour>& contours)
{
    const std::size_t n = contours.size();
    std::vector<Box2d> boxes;
    std::vector<double> sizes;
    for (const Contour& contour : contours) {
        boxes.push_back(box_of(Region2d{{contour}}));
        sizes.push_back(std::abs(area(contour)));
    }
    std::vector<std::optional<std::size_t>> around(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2d p = contours[k].front().start;
        for (std::size_t other = 0; other < n; ++other) {
            const Box2d& box = boxes[other];
            const bool smaller = around[k] && sizes[other] >= sizes[*around[k]];
            if (sizes[other] > sizes[k] && !smaller && p.x >= box.x0 && p.x <= box.x1 &&
                p.y >= box.y0 && p.y <= box.y1 && surrounds(contours[other], p)) {
                around[k] = other;
            }
        }
    }
    return around;
}

}  // namespace cusp::prismatic
