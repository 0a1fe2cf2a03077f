// An open line there and back is a contour without area: what is offset from it lies on both sides, with round ends.
#include "host_tools/cam/prismatic/line_paths.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/profile_contours.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"

namespace cusp::prismatic {

using job::CutDirection;
using job::EntryKind;
using job::Job;
using job::Operation;
using job::OutputForm;
using offset::Contour;
using offset::Edge;
using offset::point_on;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

std::vector<Edge> edges_along(const job::Chain& chain)
{
    std::vector<Edge> edges;
    for (const nurbs::Curve& curve : chain) {
        for (const Edge& edge : offset::fit_edges(curve, kFit)) {
            edges.push_back(edge);
        }
    }
    return edges;
}

std::vector<Edge> turned_around(std::vector<Edge> edges)
{
    std::reverse(edges.begin(), edges.end());
    for (Edge& edge : edges) {
        edge = reversed(edge);
    }
    return edges;
}

bool is_closed(const std::vector<Edge>& edges)
{
    return norm(edges.back().end - edges.front().start) <= kFit;
}

std::vector<Contour> around_line(const std::vector<Edge>& line, double away)
{
    std::vector<Contour> walls{line};
    if (is_closed(line)) {
        walls.push_back(turned_around(line));  // its inside and its outside
    } else {
        for (const Edge& edge : turned_around(line)) {
            walls.front().push_back(edge);
        }
    }
    std::vector<Contour> around;
    for (const Contour& wall : walls) {
        for (const Contour& contour : offset::RegionOffset{{{wall}}}.at(away).contours) {
            around.push_back(contour);
        }
    }
    return around;
}

namespace {

// mm: on the left of the edge, or of the line or circle that it is part of.
double left_of(const Edge& edge, Vec2d p)
{
    return edge.turn == 0 ? cross(offset::unit(edge.end - edge.start), p - edge.start)
                          : edge.turn * (edge.radius - norm(p - edge.centre));
}

// True if the place is on the left of the edge of the line that is nearest to it.
bool lies_left(const std::vector<Edge>& line, Vec2d p)
{
    double nearest = kUnbounded;
    double beside = 0;
    for (const Edge& edge : line) {
        const double away = distance_to(edge, p);
        const double left = left_of(edge, p);
        // at a corner of the line the edge tells that it lies more square to
        if (away < nearest - kFit || (away < nearest + kFit && std::abs(left) > std::abs(beside))) {
            beside = left;
        }
        nearest = std::min(nearest, away);
    }
    return beside > 0;
}

bool is_round_end(const Edge& edge, const std::vector<Edge>& line)
{
    const auto is_about = [&](Vec2d end) {
        return edge.turn != 0 && norm(edge.centre - end) <= kFit;
    };
    return !is_closed(line) && (is_about(line.front().start) || is_about(line.back().end));
}

}  // namespace

std::vector<std::vector<Edge>> beside_line(const std::vector<Edge>& line, double away, bool left)
{
    std::vector<std::vector<Edge>> paths;
    for (Contour contour : around_line(line, away)) {
        const auto end = std::find_if(contour.begin(), contour.end(),
                                      [&](const Edge& edge) { return is_round_end(edge, line); });
        std::rotate(contour.begin(), end == contour.end() ? contour.begin() : end, contour.end());
        bool goes_on = false;
        for (const Edge& edge : contour) {
            if (is_round_end(edge, line) || lies_left(line, point_on(edge, 0.5)) != left) {
                goes_on = false;
                continue;
            }
            if (!goes_on) {
                paths.emplace_back();
            }
            paths.back().push_back(edge);
            goes_on = true;
        }
    }
    return paths;
}

PlannedOperation cut_lines(const Job& job,
                           const Operation& operation,
                           const std::string& comment,
                           std::vector<LineCut> cuts)
{
    const std::vector<double> levels = cut_levels(job, operation, operation.prismatic->depth);
    PlannedOperation planned = begun(job, operation, comment);
    const EntryKind entry =
        operation.passes.entry == EntryKind::kPlunge ? EntryKind::kPlunge : EntryKind::kRamp;
    ToolpathWriter writer{planned.path.moves,
                          {job.stock_top + job.clearance, entry, operation.tool.radius}};
    const bool climb = operation.passes.direction_of_cut == CutDirection::kClimb;
    const EdgeForm form{operation.output != OutputForm::kLines, operation.tolerance.plan / 2,
                        climb};
    std::vector<toolpath::TourStop> stops;
    for (const LineCut& cut : cuts) {
        stops.push_back({cut.paths.front().front().start, cut.paths.front().back().end});
    }
    int passes = 0;
    for (const toolpath::TourStep& step : toolpath::short_tour(stops, {0, 0})) {
        std::vector<std::vector<Edge>>& paths = cuts[step.stop].paths;
        std::vector<Edge>& first = paths.front();
        EdgeForm along = form;
        along.exact = !cuts[step.stop].has_wall;
        const auto turn_first = [&] {
            first = turned_around(std::move(first));
            along.waste_on_left = !along.waste_on_left;
        };
        if (step.turned && along.exact) {
            turn_first();
        }
        double above = operation.prismatic->top;
        writer.approach(first.front().start, rapid_end(job, above));
        for (const double z : levels) {
            const Vec2d start = first.front().start;
            // back from the last path of the level before, in what it has cut
            writer.line(MoveKind::kCut, {start.x, start.y, writer.at().z});
            writer.enter(run_along(first, {start.x, start.y, z}, along), above,
                         [](Vec2d, double) { return std::optional<double>{}; });
            write_edges(first, z, z, along, writer);
            for (std::size_t k = 1; k < paths.size(); ++k) {
                const ContourRun run{paths[k]};
                const ContourRun from = run.turned(run.nearest_to(in_plan(writer.at())));
                const Vec2d p = from.edges().front().start;
                writer.line(MoveKind::kCut, {p.x, p.y, z});
                write_edges(from.edges(), z, z, form, writer);
            }
            passes += static_cast<int>(paths.size());
            above = z;
            if (!is_closed(first)) {
                turn_first();
            }
        }
    }
    writer.retract();
    count_moves(writer, passes, static_cast<int>(levels.size()), planned);
    return planned;
}

}  // namespace cusp::prismatic
