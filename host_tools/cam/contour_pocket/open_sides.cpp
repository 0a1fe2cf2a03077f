// The stock is taken a little smaller than it is, so that an outline drawn on its edge lies outside,
// and no two contours run along each other.
#include "host_tools/cam/contour_pocket/open_sides.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/job/job/stock_sides.hpp"

namespace cusp::contour_pocket {

using job::Job;
using job::kOnEdge;
using job::Operation;
using job::StockSides;
using offset::Box2d;
using offset::box_of;
using offset::common;
using offset::connected_parts;
using offset::Contour;
using offset::fit_contour;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;
using offset::RegionPart;
using offset::reversed;
using offset::united;
using offset::without;

namespace {

constexpr double kReach = 3.7;  // wall clearances: of the air around open stretches; less is a neck
constexpr double kStrip = 0.01;  // mm: along the edge, in which open stretches are found

Region2d rectangle(const Box2d& box)
{
    const Vec2d corners[]{{box.x0, box.y0}, {box.x1, box.y0}, {box.x1, box.y1}, {box.x0, box.y1}};
    Contour out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.push_back(line_edge(corners[i], corners[(i + 1) % 4]));
    }
    return {{out}};
}

// The stock, smaller by `inset` (mm). Sides that the job does not give are farther out than `beyond`.
Region2d stock_region(const Job& job, const Box2d& beyond, double inset)
{
    constexpr double kFit = 2e-4;  // mm: of free-form curves by arcs
    if (job.stock_outline.empty()) {
        const StockSides sides = job::stock_sides(job);
        return rectangle(
            {std::max(sides.x_low, beyond.x0) + inset, std::max(sides.y_low, beyond.y0) + inset,
             std::min(sides.x_high, beyond.x1) - inset, std::min(sides.y_high, beyond.y1) - inset});
    }
    Region2d stock;
    for (const job::Loop& loop : job.stock_outline) {
        const Contour contour = fit_contour(loop, kFit);
        stock.contours.push_back(stock.contours.empty() ? contour : reversed(contour));
    }
    return RegionOffset{std::move(stock)}.at(inset);
}

// The strip between two regions, one inside the other.
Region2d strip_between(const Region2d& outer, const Region2d& inner)
{
    Region2d strip = outer;
    const Region2d hole = reversed(inner);
    strip.contours.insert(strip.contours.end(), hole.contours.begin(), hole.contours.end());
    return strip;
}

// Parts of the region for which keeps(part).
template <class Keeps>
Region2d parts_of(const Region2d& region, const Keeps& keeps)
{
    Region2d out;
    for (const RegionPart& part : connected_parts(region)) {
        Region2d alone{{region.contours[part.outer]}};
        for (const std::size_t hole : part.holes) {
            alone.contours.push_back(region.contours[hole]);
        }
        if (keeps(alone)) {
            out.contours.insert(out.contours.end(), alone.contours.begin(), alone.contours.end());
        }
    }
    return out;
}

Box2d grown_box(const Box2d& box, double by)
{
    return {box.x0 - by, box.y0 - by, box.x1 + by, box.y1 + by};
}

}  // namespace

bool lies_beside_stock(const Job& job, const Region2d& pocket)
{
    if (!job.stock_outline.empty()) {
        return common(pocket, stock_region(job, {}, kOnEdge)).contours.empty();
    }
    const StockSides sides = job::stock_sides(job);
    const Box2d box = box_of(pocket);
    return box.x0 >= sides.x_high || box.x1 <= sides.x_low || box.y0 >= sides.y_high ||
           box.y1 <= sides.y_low;
}

std::optional<OpenSides> open_sides(const Job& job,
                                    const Operation& operation,
                                    const Region2d& pocket,
                                    double wall_clearance)
{
    if ((job.stock_outline.empty() && !is_open_pocket(job, operation)) ||
        lies_beside_stock(job, pocket)) {
        return std::nullopt;
    }
    const double reach = kReach * wall_clearance;
    const Box2d beyond = grown_box(box_of(pocket), 4.0 * reach);
    const Region2d stock = stock_region(job, beyond, kOnEdge);
    const Region2d core = stock_region(job, beyond, kOnEdge + kStrip);
    const Region2d stretches = common(pocket, strip_between(stock, core));
    if (stretches.contours.empty()) {
        return std::nullopt;
    }
    const Region2d reached = grown(stretches, reach);
    // Across a thin wall the tool comes to other ground, which is none of this pocket's.
    const Region2d outside = without(reached, stock_region(job, beyond, kOnEdge + 1.5 * kStrip));
    const Region2d beside_them = parts_of(
        outside, [&](const Region2d& part) { return !common(part, stretches).contours.empty(); });
    const bool is_whole = beside_them.contours.size() == outside.contours.size();
    const Region2d& around = is_whole ? reached : beside_them;
    const Region2d centres = grown(stretches, reach - wall_clearance);
    const Region2d stays = without(stock, pocket);
    const double beside = std::max(wall_clearance, operation.tool.radius + 2.0 * kOnEdge);
    OpenSides open;
    open.region = without(united(around, core), stays);
    open.in_stock = common(pocket, stock);
    open.air = without(around, stock);
    open.starts = without(centres, grown(stock, beside));
    if (!is_whole) {
        open.starts = parts_of(open.starts, [&](const Region2d& part) {
            return contains(beside_them, part.contours.front().front().start);
        });
    }
    return open;
}

}  // namespace cusp::contour_pocket
