// Each band by itself: the first vee of its angle that is wide enough.
#include "host_tools/job/import/solid_chamfers.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/import/solid_edges.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"

namespace cusp::import {

using offset::Contour;
using offset::EdgeTree;
using offset::Region2d;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kSameFlank = 0.01;  // mm: widths of a band and of a flank as high

Tool vee_of(const NamedTool& named, double unit)
{
    Tool tool;
    tool.shape = ToolShape::kVee;
    tool.radius = named.diameter * unit / 2;
    tool.tip_angle = named.tip_angle * kPi / 180;
    return tool;
}

double flank_width(const Tool& vee, const EdgeBand& band)
{
    return (band.high - band.low) * elementary::tan(vee.tip_angle / 2);
}

// True if the tip has room beside each loop.
bool has_room(const Region2d& loops, const Region2d& centres)
{
    if (centres.contours.empty()) {
        return false;
    }
    const EdgeTree tree{edges_of(centres)};
    return std::all_of(loops.contours.begin(), loops.contours.end(), [&](const Contour& loop) {
        return std::any_of(loop.begin(), loop.end(), [&](const offset::Edge& edge) {
            return tree.any_nearer(point_on(edge, 0.5), 1.01 * job::kChamferTip);
        });
    });
}

// The ground within `reach` of the loops.
Region2d strips(const Region2d& loops, double reach)
{
    Region2d all;
    for (const Contour& loop : loops.contours) {
        const Region2d within{{offset::area(loop) > 0 ? loop : reversed(loop)}};
        all = offset::united(all, offset::without(offset::grown(within, reach),
                                                  offset::RegionOffset{within}.at(reach)));
    }
    return all;
}

void choose_vee(const SolidEdges& edges,
                const std::vector<NamedTool>& tools,
                double unit,
                SolidChamfer& chamfer)
{
    const Region2d centres =
        offset::RegionOffset{offset::reversed(chamfer.loops)}.at(job::kChamferTip);
    const bool fits = has_room(chamfer.loops, centres);
    for (std::size_t k = 0; k < tools.size() && !chamfer.tool; ++k) {
        const Tool vee = vee_of(tools[k], unit);
        if (tools[k].shape != name_of(ToolShape::kVee) ||
            std::abs(flank_width(vee, chamfer.band) - chamfer.band.width) > kSameFlank) {
            continue;
        }
        const double width = flank_width(vee, chamfer.band);
        const double tip =
            chamfer.band.high - (width + job::kChamferTip) / elementary::tan(vee.tip_angle / 2);
        if (job::kChamferTip + width > vee.radius) {
            chamfer.fault = ChamferFault::kTooNarrow;
        } else if (!fits) {
            chamfer.fault = ChamferFault::kNoRoom;
        } else if (!edges.is_clear(vee, centres, tip)) {
            chamfer.fault = ChamferFault::kWouldGouge;
        } else {
            chamfer.tool = k;
            chamfer.band.width = width;
            chamfer.near = strips(chamfer.loops, vee.radius + job::kChamferTip);
        }
    }
}

}  // namespace

std::vector<SolidChamfer> solid_chamfers(const Triangles& facets,
                                         const std::vector<NamedTool>& tools,
                                         double unit)
{
    const SolidEdges edges{facets};
    std::vector<SolidChamfer> all;
    for (const EdgeBand& band : edges.bands()) {
        const double half = elementary::atan(band.width / (band.high - band.low));
        constexpr double kSteps = 2;  // to a degree
        all.push_back({band,
                       std::round(2 * half * 180 / kPi * kSteps) / kSteps,
                       std::nullopt,
                       ChamferFault::kNoVee,
                       edges.loops(band),
                       {}});
        choose_vee(edges, tools, unit, all.back());
    }
    return all;
}

double least_vee(const SolidChamfer& chamfer)
{
    return std::ceil(2 * (chamfer.band.width + job::kChamferTip));
}

}  // namespace cusp::import
