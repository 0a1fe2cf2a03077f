// Lines are exact intervals of the clear zone, outlines offsets of the region between the boxes.
#include "host_tools/cam/hull_rough/layer_clearing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::hull_rough {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptiveRun;
using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using clearing::ClearingPass;
using clearing::ClearingSettings;
using clearing::LayerRun;
using clearing::PassStart;
using job::CutDirection;
using offset::arc_edge;
using offset::area;
using offset::Box2d;
using offset::Contour;
using offset::Edge;
using offset::EdgeTree;
using offset::length;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;
using offset::reversed;

namespace {

Rectangle grown_box(const Rectangle& box, double by)
{
    return {box.x_min - by, box.y_min - by, box.x_max + by, box.y_max + by};
}

Contour contour_of(const std::vector<Vec2d>& corners)
{
    Contour out;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        out.push_back(line_edge(corners[i], corners[(i + 1) % corners.size()]));
    }
    return out;
}

// The periphery as an outer contour and the boxes' outlines as holes.
Region2d free_region(const std::vector<Rectangle>& boxes, const Rectangle& p)
{
    Region2d region;
    region.contours.push_back(contour_of(
        {{p.x_min, p.y_min}, {p.x_max, p.y_min}, {p.x_max, p.y_max}, {p.x_min, p.y_max}}));
    for (std::vector<Vec2d>& loop : union_outline(boxes)) {
        std::reverse(loop.begin(), loop.end());
        region.contours.push_back(contour_of(loop));
    }
    return region;
}

bool on_border(const Contour& contour, const Rectangle& field)
{
    return std::any_of(contour.begin(), contour.end(), [&](const Edge& e) {
        return std::abs(e.start.x - field.x_min) < 1e-6 || std::abs(e.start.x - field.x_max) < 1e-6;
    });
}

std::vector<Edge> edges_of(const Chain& chain)
{
    std::vector<Edge> out;
    for (std::size_t i = 1; i < chain.size(); ++i) {
        if (norm(chain[i] - chain[i - 1]) > 1e-9) {
            out.push_back(line_edge(chain[i - 1], chain[i]));
        }
    }
    return out;
}

// The contour, starting at a point on its edge `first`.
std::vector<Edge> begun_at(const Contour& contour, std::size_t first, Vec2d point)
{
    std::vector<Edge> out;
    const Edge& edge = contour[first];
    if (norm(edge.end - point) > 1e-6) {
        out.push_back(between(edge, point, edge.end));
    }
    for (std::size_t i = 1; i < contour.size(); ++i) {
        out.push_back(contour[(first + i) % contour.size()]);
    }
    if (norm(edge.start - point) > 1e-6) {
        out.push_back(between(edge, edge.start, point));
    }
    return out;
}

// For each contour an end of a cut line on it, so that it is entered in cleared stock.
class Beginnings {
public:
    explicit Beginnings(const std::vector<Contour>& contours)
    {
        std::vector<Edge> edges;
        for (std::size_t c = 0; c < contours.size(); ++c) {
            for (std::size_t e = 0; e < contours[c].size(); ++e) {
                edges.push_back(contours[c][e]);
                places_.push_back({c, e});
            }
        }
        edges_ = edges;
        tree_.emplace(edges);
        found_.resize(contours.size());
    }

    void offer(Vec2d point)
    {
        constexpr double kNear = 1e-5;
        const Box2d box{point.x - kNear, point.y - kNear, point.x + kNear, point.y + kNear};
        tree_->visit_meeting(box, [&](std::uint32_t i) {
            auto& slot = found_[places_[i].first];
            if (!slot && distance_to(edges_[i], point) < kNear) {
                slot = std::make_pair(places_[i].second, nearest_on(edges_[i], point));
            }
        });
    }

    const std::optional<std::pair<std::size_t, Vec2d>>& of(std::size_t contour) const
    {
        return found_[contour];
    }

private:
    std::vector<Edge> edges_;
    std::vector<std::pair<std::size_t, std::size_t>> places_;
    std::vector<std::optional<std::pair<std::size_t, Vec2d>>> found_;
    std::optional<EdgeTree> tree_;
};

std::vector<LayerRun> outline_runs(const std::vector<Contour>& outlines,
                                   const std::vector<LayerRun>& lines,
                                   bool climb)
{
    std::vector<LayerRun> out;
    Beginnings beginnings{outlines};
    for (const LayerRun& run : lines) {
        for (const Edge& edge : run.edges) {
            beginnings.offer(edge.start);
            beginnings.offer(edge.end);
        }
    }
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const auto& begin = beginnings.of(i);
        LayerRun run{begin ? begun_at(outlines[i], begin->first, begin->second) : outlines[i],
                     begin.has_value()};
        // The contour has the region on its left and the island on its right: climb milling for a
        // clockwise spindle.
        if (!climb) {
            run.edges = reversed(run.edges);
        }
        out.push_back(std::move(run));
    }
    return out;
}

// Greedy order by the nearest start; with `either_way` runs may be reversed.
std::vector<LayerRun> in_near_order(std::vector<LayerRun> runs, bool either_way)
{
    // Quadratic: more runs keep the order of the lines, which is nearly as good.
    constexpr std::size_t kMost = 2000;
    if (runs.size() > kMost) {
        return runs;
    }
    for (std::size_t done = 1; done < runs.size(); ++done) {
        const Vec2d here = runs[done - 1].edges.back().end;
        std::size_t best = done;
        bool turn = false;
        double least = kUnbounded;
        for (std::size_t i = done; i < runs.size(); ++i) {
            const double forth = norm(runs[i].edges.front().start - here);
            const double back = either_way ? norm(runs[i].edges.back().end - here) : kUnbounded;
            if (std::min(forth, back) < least) {
                least = std::min(forth, back);
                best = i;
                turn = back < forth;
            }
        }
        std::swap(runs[done], runs[best]);
        if (turn) {
            runs[done].edges = reversed(runs[done].edges);
        }
    }
    return runs;
}

double length_of(const std::vector<LayerRun>& runs)
{
    double sum = 0;
    for (const LayerRun& run : runs) {
        sum += length(Contour{run.edges});
    }
    return sum;
}

// The area beside the stock that a cutter sweeps with its axis everywhere in the field, mm^2.
double area_outside(const Rectangle& stock, const Rectangle& field, double radius)
{
    const double width = field.x_max - field.x_min + 2 * radius;
    const double depth = field.y_max - field.y_min + 2 * radius;
    const double corners = (4 - kPi) * radius * radius;
    return width * depth - corners - (stock.x_max - stock.x_min) * (stock.y_max - stock.y_min);
}

// True if the whole path stays in the zone, to the tolerance.
bool keeps_clear(const std::vector<Edge>& path, const ClearZone& zone, double tolerance)
{
    return std::all_of(path.begin(), path.end(), [&](const Edge& edge) {
        int pieces = 1;
        if (edge.turn != 0) {
            const double step = 2 * std::sqrt(2 * std::min(tolerance / 2 / edge.radius, 0.5));
            pieces = static_cast<int>(std::ceil(sweep(edge) / step));
        }
        for (int i = 0; i < pieces; ++i) {
            const Vec2d a = point_on(edge, static_cast<double>(i) / pieces);
            const Vec2d b = point_on(edge, static_cast<double>(i + 1) / pieces);
            if (!zone.nearly_clear(a, b, tolerance)) {
                return false;
            }
        }
        return true;
    });
}

// Loops parallel to the outlines, in the order of clear_region(); linked loops are one run. Loops
// on the border of the field are outside the stock and left out.
std::vector<LayerRun> parallel_runs(const Region2d& region,
                                    const ClearZone& zone,
                                    const LayerSettings& settings)
{
    ClearingSettings clearing;
    clearing.wall_clearance = zone.radius();
    clearing.stepover = settings.step;
    clearing.direction = settings.direction;
    std::vector<LayerRun> out;
    bool linked = false;  // the pass before is cut, so a link from it is possible
    for (const ClearingPass& pass : clear_region(region, clearing).passes) {
        const bool inside = !on_border(pass.path, zone.field());
        if (inside && linked && pass.start == PassStart::kLink &&
            zone.clear(out.back().edges.back().end, pass.path.front().start)) {
            std::vector<Edge>& edges = out.back().edges;
            const Vec2d from = edges.back().end;
            if (norm(pass.path.front().start - from) > 1e-9) {
                edges.push_back(line_edge(from, pass.path.front().start));
            }
            edges.insert(edges.end(), pass.path.begin(), pass.path.end());
        } else if (inside) {
            out.push_back({pass.path, false});
        }
        linked = inside;
    }
    return out;
}

std::vector<LayerRun> zigzag_runs(const ClearZone& zone,
                                  const Rectangle& stock,
                                  const LayerSettings& settings)
{
    ZigzagLayout layout = zigzag_layout(stock.y_min, stock.y_max, settings.step);
    layout.one_way = settings.one_way;
    std::vector<LayerRun> out;
    for (const Chain& chain : zigzag_chains(zone, layout)) {
        LayerRun run{edges_of(chain), false};
        if (!run.edges.empty()) {
            out.push_back(std::move(run));
        }
    }
    return in_near_order(std::move(out), !settings.one_way);
}

// The places of an adaptive path; entries are their foot and the turns that widen it.
std::vector<LayerRun> runs_of(const AdaptivePath& path)
{
    std::vector<LayerRun> out;
    for (const AdaptiveRun& run : path.runs) {
        if (!run.helix) {
            out.push_back({run.path, true});
            continue;
        }
        const Vec2d c = run.helix->centre;
        std::vector<Edge> turns{line_edge(c, c)};
        turns.insert(turns.end(), run.path.begin(), run.path.end());
        out.push_back({std::move(turns), false});
    }
    return out;
}

// mm: from the limits of the axis to the stock: a strip in which a pass may start and turn. With less
// than 1.7 radii of room it would be a neck, to be opened by trochoids.
double open_strip(double kept, bool adaptive) { return adaptive ? 2.7 * kept : 1.1 * kept; }

}  // namespace

AdaptivePath adaptive_layer(const LayerClearing& clearing,
                            const Rectangle& stock,
                            double radius,
                            const LayerSettings& settings,
                            const std::vector<ClearedBy>& before)
{
    constexpr double kBeside = 2e-3;  // mm from the cutter to the stock
    AdaptiveSettings adaptive;
    adaptive.tool_radius = settings.clears;
    adaptive.wall_clearance = clearing.zone->radius();
    adaptive.max_engagement = *settings.max_engagement;
    adaptive.tolerance = std::min(settings.tolerance / 2, 0.005 * settings.clears);
    adaptive.corner = settings.tolerance / 2;
    adaptive.direction = settings.direction;
    Region2d beside;
    const Rectangle& field = clearing.zone->field();
    beside.contours.push_back(contour_of({{field.x_min, field.y_min},
                                          {field.x_max, field.y_min},
                                          {field.x_max, field.y_max},
                                          {field.x_min, field.y_max}}));
    const Contour outline = contour_of({{stock.x_min, stock.y_min},
                                        {stock.x_max, stock.y_min},
                                        {stock.x_max, stock.y_max},
                                        {stock.x_min, stock.y_max}});
    for (const Contour& hole : grown(Region2d{{outline}}, radius + kBeside).contours) {
        beside.contours.push_back(reversed(hole));
    }
    adaptive.open.push_back(std::move(beside));
    for (const ClearedBy& by : before) {
        const Region2d& centres = by.clearing->centres->source();
        if (centres.contours.empty()) {
            continue;
        }
        Region2d region = by.rest_offset > 0   ? grown(centres, by.rest_offset)
                          : by.rest_offset < 0 ? by.clearing->centres->at(-by.rest_offset)
                                               : centres;
        adaptive.open.push_back(std::move(region));
    }
    return clear_adaptively(free_region(clearing.boxes, grown_box(field, clearing.zone->radius())),
                            adaptive);
}

namespace {

void clear_adaptively(LayerClearing& out,
                      const Rectangle& stock,
                      double radius,
                      const LayerSettings& settings)
{
    out.adaptive = adaptive_layer(out, stock, radius, settings, {});
    out.runs = runs_of(*out.adaptive);
    out.left = uncovered_spots(out.runs, *out.centres, settings.clears, stock);
    out.length = out.adaptive->length;
}

}  // namespace

LayerClearing clear_layer(const std::vector<Rectangle>& boxes,
                          const Rectangle& stock,
                          double radius,
                          const LayerSettings& settings)
{
    // Chuang & Pan, section 5: the periphery is the stock expanded by 2.1 radii, so that islands at
    // the edge of the stock do not touch it and the cutter turns outside.
    const double kept = radius + settings.tolerance + settings.side_allowance;
    const Rectangle field = grown_box(stock, open_strip(kept, settings.max_engagement.has_value()));
    LayerClearing out;
    out.zone = std::make_shared<ClearZone>(boxes, field, kept);
    const Region2d region = free_region(boxes, grown_box(field, kept));
    const RegionOffset source{region};
    const Region2d centres = source.at(kept);
    out.centres = std::make_shared<RegionOffset>(centres);
    out.cleared_area =
        std::max(0.0, area(grown(centres, radius)) - area_outside(stock, field, radius));
    std::vector<Contour> outlines;
    for (const Contour& contour : centres.contours) {
        if (!on_border(contour, field)) {
            outlines.push_back(contour);
        }
    }
    out.islands = static_cast<int>(outlines.size());
    if (settings.max_engagement) {
        out.boxes = boxes;
        clear_adaptively(out, stock, radius, settings);
        return out;
    }
    if (settings.contour) {
        out.runs = parallel_runs(region, *out.zone, settings);
        // Loops have no proof of clearance: each pass is checked against the boxes.
        out.by_contours = std::all_of(out.runs.begin(), out.runs.end(), [&](const LayerRun& run) {
            return keeps_clear(run.edges, *out.zone, settings.tolerance);
        });
    }
    const auto proven_runs = [&] {
        std::vector<LayerRun> runs = zigzag_runs(*out.zone, stock, settings);
        std::vector<LayerRun> around = in_near_order(
            outline_runs(outlines, runs, settings.direction == CutDirection::kClimb), false);
        runs.insert(runs.end(), around.begin(), around.end());
        return runs;
    };
    if (!out.by_contours) {
        out.runs = proven_runs();
    }
    UncoveredSpots uncovered = uncovered_spots(out.runs, *out.centres, settings.clears, stock);
    if (!uncovered.squares.empty() && out.by_contours) {
        out.closed_area = uncovered.area;
        const std::vector<LayerRun> rest =
            in_near_order(runs_near(proven_runs(), uncovered, settings.clears), false);
        out.runs.insert(out.runs.end(), rest.begin(), rest.end());
        uncovered = uncovered_spots(out.runs, *out.centres, settings.clears, stock);
    }
    out.left = std::move(uncovered);
    out.length = length_of(out.runs);
    return out;
}

std::vector<LayerRun> uncut_runs(const LayerClearing& clearing,
                                 double radius,
                                 const std::vector<ClearedBy>& before)
{
    // A point is cleared if the region of an earlier cutter is near enough. Between samples the
    // distance changes by no more than the distance between them.
    const double step = radius / 16;
    const auto done_by = [&](const ClearedBy& by, Vec2d from, Vec2d to) {
        const double least = step / 2 - by.rest_offset;
        return by.clearing->centres->clearance(from) >= least &&
               by.clearing->centres->clearance(to) >= least;
    };
    std::vector<LayerRun> out;
    for (const LayerRun& run : clearing.runs) {
        LayerRun part;
        bool done_before = false;
        for (const Edge& edge : run.edges) {
            const int pieces = std::max(1, static_cast<int>(std::ceil(length(edge) / step)));
            Vec2d from = edge.start;
            for (int i = 1; i <= pieces; ++i) {
                const Vec2d to = point_on(edge, static_cast<double>(i) / pieces);
                const bool done =
                    std::any_of(before.begin(), before.end(),
                                [&](const ClearedBy& by) { return done_by(by, from, to); });
                if (!done && part.edges.empty()) {
                    part.starts_in_cleared_stock = done_before;
                }
                if (!done) {
                    part.edges.push_back(between(edge, from, to));
                } else if (!part.edges.empty()) {
                    out.push_back(std::exchange(part, {}));
                }
                done_before = done;
                from = to;
            }
        }
        if (!part.edges.empty()) {
            out.push_back(std::move(part));
        }
    }
    return out;
}

}  // namespace cusp::hull_rough
