// The contours at half of the cut's width from the region that the loops bound.
#include "host_tools/job/import/groove_sides.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/job/import/part_regions.hpp"

namespace cusp::import {

using offset::Contour;
using offset::Edge;
using offset::Region2d;

namespace {

constexpr double kGrooveFit = 5e-4;  // mm

Region2d material_of_loops(const std::vector<job::NestedLoop>& loops)
{
    Region2d region;
    for (const job::NestedLoop& loop : loops) {
        const Contour contour = offset::fit_contour(loop.loop, kGrooveFit);
        if (contour.empty() || !(std::abs(area(contour)) > 0)) {
            throw InputError(loop.name + ": the loop encloses nothing");
        }
        region.contours.push_back((area(contour) > 0) == loop.hole ? reversed(contour) : contour);
    }
    return region;
}

}  // namespace

BesideLoops beside_loops(const std::vector<job::NestedLoop>& loops,
                         const toolpath::Tool& tool,
                         double depth,
                         bool inside)
{
    const double away = radius_at_height(tool, depth);
    const Region2d material = material_of_loops(loops);
    const Region2d ways =
        offset::RegionOffset{inside ? material : offset::reversed(material)}.at(away);
    BesideLoops beside;
    for (const Contour& contour : ways.contours) {
        job::Chain chain;
        std::transform(contour.begin(), contour.end(), std::back_inserter(chain), drawn_curve);
        beside.chains.push_back(std::move(chain));
    }
    constexpr double kCorner =
        1.5;  // of the distance: a groove turns in a square corner at the root of 2
    const offset::EdgeTree tree{edges_of(ways)};
    for (const Contour& contour : material.contours) {
        for (const Edge& edge : contour) {
            for (const Edge& piece : offset::pieces_of(edge, std::max(away, 0.05))) {
                const Vec2d middle = point_on(piece, 0.5);
                if (!tree.any_nearer(middle, kCorner * away)) {
                    beside.unreached += length(piece);
                    beside.place = beside.place ? beside.place : middle;
                }
            }
        }
    }
    return beside;
}

}  // namespace cusp::import
