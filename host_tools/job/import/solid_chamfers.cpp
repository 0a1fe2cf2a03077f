// Each band by itself: the first vee of its angle that breaks all of its edges, else the one that breaks most of them.
#include "host_tools/job/import/solid_chamfers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/import/drawing_choice.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"

#include "fmt/format.h"

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
    tool.tip_radius = named.tip_diameter * unit / 2;
    return tool;
}

double flank_width(const Tool& vee, const EdgeBand& band)
{
    return (band.high - band.low) * elementary::tan(vee.tip_angle / 2);
}

// True if the tip has room beside each loop.
bool has_room(const Region2d& loops, const Region2d& centres, double away)
{
    if (centres.contours.empty()) {
        return false;
    }
    const EdgeTree tree{edges_of(centres)};
    return std::all_of(loops.contours.begin(), loops.contours.end(), [&](const Contour& loop) {
        return std::any_of(loop.begin(), loop.end(), [&](const offset::Edge& edge) {
            return tree.any_nearer(point_on(edge, 0.5), 1.01 * away);
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

// The ground within `reach` of the ways.
Region2d strips(const std::vector<std::vector<offset::Edge>>& ways, double reach)
{
    Region2d all;
    for (const std::vector<offset::Edge>& way : ways) {
        for (const offset::Edge& edge : way) {
            const double most = edge.turn == 0 ? length(edge) : reach / 2;
            for (const offset::Edge& piece : offset::pieces_of(edge, most)) {
                const Vec2d along = offset::unit(piece.end - piece.start) * reach;
                const Vec2d aside = offset::left_normal(along);
                const std::array<Vec2d, 4> corners{
                    piece.start - along - aside, piece.end + along - aside,
                    piece.end + along + aside, piece.start - along + aside};
                Contour box;
                for (std::size_t k = 0; k < corners.size(); ++k) {
                    box.push_back(offset::line_edge(corners[k], corners[(k + 1) % corners.size()]));
                }
                all = offset::united(all, {{box}});
            }
        }
    }
    return all;
}

void choose_vee(const SolidEdges& edges,
                const std::vector<NamedTool>& tools,
                double unit,
                SolidChamfer& chamfer)
{
    for (std::size_t k = 0; k < tools.size(); ++k) {
        const Tool vee = vee_of(tools[k], unit);
        if (tools[k].shape != name_of(ToolShape::kVee) ||
            std::abs(flank_width(vee, chamfer.band) - chamfer.band.width) > kSameFlank) {
            continue;
        }
        EdgeBand band = chamfer.band;
        band.width = flank_width(vee, band);
        const double away = vee.tip_radius + job::kChamferTip;
        const Region2d centres = offset::RegionOffset{offset::reversed(chamfer.loops)}.at(away);
        const double tip =
            band.high - (band.width + job::kChamferTip) / elementary::tan(vee.tip_angle / 2);
        if (away + band.width > vee.radius) {
            chamfer.fault = ChamferFault::kTooNarrow;
            continue;
        }
        const double reach = vee.radius + away;
        if (!chamfer.all.has_parts && has_room(chamfer.loops, centres, away) &&
            edges.is_clear(vee, centres, tip)) {
            chamfer.near = strips(chamfer.loops, reach);
            chamfer.ways.reset();
            chamfer.beside = 0;
            chamfer.band = band;
            chamfer.tool = k;
            return;
        }
        EdgeWays ways = edges.ways(band, vee);
        if (ways.broken > (chamfer.ways ? chamfer.ways->broken : 0.0)) {
            chamfer.near = strips(ways.ways, reach);
            chamfer.ways = std::move(ways);
            chamfer.beside = away;
            chamfer.band = band;
            chamfer.tool = k;
        } else if (!chamfer.tool) {
            chamfer.fault =
                centres.contours.empty() ? ChamferFault::kNoRoom : ChamferFault::kWouldGouge;
        }
    }
}

// The circle of a mouth's foot; none: the loop is another one.
struct MouthFoot {
    Vec2d centre;
    double radius;
};

std::optional<MouthFoot> foot_of(const Contour& loop)
{
    constexpr double kRound = 0.01;  // mm: facets of the wall lie beside it
    const offset::Box2d box = offset::box_of(Region2d{{loop}});
    const Vec2d centre{(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2};
    const double radius = (box.x1 - box.x0 + box.y1 - box.y0) / 4;
    const bool is_round =
        offset::area(loop) < 0 && std::all_of(loop.begin(), loop.end(), [&](const offset::Edge& e) {
            return std::abs(offset::distance(e.start, centre) - radius) <= kRound &&
                   std::abs(offset::distance(point_on(e, 0.5), centre) - radius) <= kRound;
        });
    return is_round ? std::optional{MouthFoot{centre, radius}} : std::nullopt;
}

// The first tool whose cone has the angle and the width, and gouges nothing in any of the mouths.
void choose_sink(const SolidEdges& edges,
                 const std::vector<NamedTool>& tools,
                 double unit,
                 SolidChamfer& chamfer)
{
    SolidChamfer::Sink sink{0, {}, 0, {}};
    for (const Contour& loop : chamfer.loops.contours) {
        const auto foot = foot_of(loop);
        const double width = foot ? 2 * (foot->radius + chamfer.band.width) : 0.0;
        if (!foot || (sink.width > 0 && std::abs(width - sink.width) > kSameFlank)) {
            return;
        }
        sink.centres.push_back(foot->centre);
        sink.width = width;
        sink.near.contours.push_back(hole_disc({foot->centre, width}).contours.front());
    }
    if (chamfer.all.has_parts || sink.centres.empty()) {
        return;
    }
    for (sink.tool = 0; sink.tool < tools.size(); ++sink.tool) {
        const NamedTool& named = tools[sink.tool];
        const bool is_drill = named.shape == name_of(ToolShape::kDrill);
        Tool cone = vee_of(named, unit);
        cone.shape = is_drill ? ToolShape::kDrill : ToolShape::kVee;
        constexpr double kSameAngle = 0.5;  // degrees, as angles are rounded to that
        if ((!is_drill && named.shape != name_of(ToolShape::kVee)) ||
            std::abs(named.tip_angle - chamfer.angle) > kSameAngle / 2 ||
            2 * cone.radius < sink.width - kSameFlank) {
            continue;
        }
        const double tip =
            chamfer.band.high - profile_height(cone, std::min(cone.radius, sink.width / 2));
        if (std::all_of(sink.centres.begin(), sink.centres.end(),
                        [&](Vec2d at) { return edges.is_clear(cone, at, tip); })) {
            chamfer.sink = sink;
            return;
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
                       std::nullopt,
                       edges.survey(band),
                       {},
                       0,
                       std::nullopt});
        choose_vee(edges, tools, unit, all.back());
        if (!all.back().tool || all.back().ways) {
            choose_sink(edges, tools, unit, all.back());
        }
    }
    return all;
}

std::vector<offset::Edge> SolidChamfer::edges() const
{
    if (!ways) {
        return edges_of(loops);
    }
    std::vector<offset::Edge> all;
    for (const std::vector<offset::Edge>& way : ways->ways) {
        all.insert(all.end(), way.begin(), way.end());
    }
    return all;
}

double SolidChamfer::depth() const
{
    return (band.width + job::kChamferTip) * (band.high - band.low) / band.width;
}

IsCutApart cut_by_vees(const std::vector<SolidChamfer>& chamfers)
{
    std::vector<BandGround> made;
    for (const SolidChamfer& chamfer : chamfers) {
        if (chamfer.sink) {
            made.emplace_back(chamfer.band, edges_of(chamfer.loops), 0);
        } else if (chamfer.tool) {
            made.emplace_back(chamfer.band, chamfer.edges(), chamfer.beside);
        }
    }
    const auto all = std::make_shared<const std::vector<BandGround>>(std::move(made));
    return [all](const std::array<Vec3d, 3>& facet) {
        return std::any_of(all->begin(), all->end(),
                           [&](const BandGround& band) { return band.has(facet); });
    };
}

std::string words_of(const SolidChamfer& chamfer, ChamferFault fault, bool inch)
{
    const double least = std::ceil(2 * (chamfer.band.width + job::kChamferTip));  // mm
    const std::string vee =
        fmt::format("--tool vee:{:g}{}:{:g}", least, inch ? "mm" : "", chamfer.angle);
    switch (fault) {
        case ChamferFault::kNoVee:
            return fmt::format("no vee has their {:g} degrees; {} cuts them", chamfer.angle, vee);
        case ChamferFault::kTooNarrow:
            return fmt::format("the vee's flank is too narrow; {} cuts them", vee);
        case ChamferFault::kNoRoom:
            return "the vee's tip has no room beside them";
        case ChamferFault::kWouldGouge:
            return "the vee would gouge the part beside them";
        case ChamferFault::kStockBeside:
            break;
    }
    return "stock stands there that no flat end reaches";
}

std::optional<SunkHoles> sunk_holes(const SolidChamfer& chamfer, const CadHoles& found)
{
    const SolidChamfer::Sink& sink = *chamfer.sink;
    SunkHoles sunk{0, 0};
    std::size_t count = 0;
    for (std::size_t k = 0; k < found.holes.size(); ++k) {
        const job::Hole& hole = found.holes[k];
        const double across = sink.width - 2 * chamfer.band.width;
        if (std::abs(hole.diameter - across) > kSameDiameter ||
            std::abs(hole.span->top - chamfer.band.low) > kSameDiameter) {
            continue;
        }
        if (!found.cones[k] || std::abs(found.cones[k]->diameter - sink.width) > kSameDiameter) {
            return std::nullopt;
        }
        sunk = {hole.diameter, found.cones[k]->diameter};
        ++count;
    }
    return count == sink.centres.size() ? std::optional{sunk} : std::nullopt;
}

}  // namespace cusp::import
