// An arc becomes chords where the part is on its convex side and tangents where it is on the hollow
// one, so no line cuts into the part.
#include "host_tools/cam/prismatic/contour_run.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::prismatic {

using offset::between;
using offset::distance;
using offset::Edge;
using offset::nearest_on;
using offset::point_on;
using offset::sweep;
using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::MoveKind;
using toolpath::ToolpathWriter;

namespace {

constexpr double kLeastPiece = 1e-7;  // mm

// Lines in place of one arc.
void add_lines(const Edge& arc, const EdgeForm& form, std::vector<Vec2d>& points)
{
    // an arc to the left has its hollow side on its left
    const bool tangents = !form.exact && (arc.turn > 0) != form.waste_on_left;
    const double share = std::clamp(1 - form.tolerance / arc.radius, -0.5, 1 - 1e-9);
    const double step = 2 * elementary::acos(share);
    const int pieces = std::max(1, static_cast<int>(std::ceil(sweep(arc) / step)));
    if (!tangents) {
        for (int i = 1; i < pieces; ++i) {
            points.push_back(point_on(arc, static_cast<double>(i) / pieces));
        }
    } else {
        const double out = 1 / elementary::cos(sweep(arc) / pieces / 2);
        for (int i = 0; i < pieces; ++i) {
            const Vec2d middle = point_on(arc, (i + 0.5) / pieces);
            points.push_back(arc.centre + (middle - arc.centre) * out);
        }
    }
    points.push_back(arc.end);
}

}  // namespace

ContourRun::ContourRun(std::vector<Edge> edges) : edges_{std::move(edges)}
{
    double sum = 0;
    for (const Edge& edge : edges_) {
        sum += offset::length(edge);
        ends_.push_back(sum);
    }
}

Vec2d ContourRun::point(double at) const
{
    const auto found = std::lower_bound(ends_.begin(), ends_.end(), at);
    const auto k = std::min(static_cast<std::size_t>(found - ends_.begin()), edges_.size() - 1);
    const double whole = ends_[k] - begin_of(k);
    return point_on(edges_[k], whole > 0 ? std::clamp((at - begin_of(k)) / whole, 0.0, 1.0) : 0.0);
}

double ContourRun::nearest_to(Vec2d p) const
{
    double best = kUnbounded;
    double at = 0;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
        const Vec2d q = nearest_on(edges_[k], p);
        if (const double d = distance(p, q); d < best) {
            best = d;
            at = begin_of(k) + offset::length(between(edges_[k], edges_[k].start, q));
        }
    }
    return std::min(at, length());
}

std::vector<Edge> ContourRun::part(double from, double to) const
{
    std::vector<Edge> out;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
        const double begin = std::max(from, begin_of(k));
        const double end = std::min(to, ends_[k]);
        if (end - begin < kLeastPiece) {
            continue;
        }
        const double whole = ends_[k] - begin_of(k);
        Edge edge = edges_[k];
        if (begin > begin_of(k) || end < ends_[k]) {
            const Vec2d a =
                begin > begin_of(k) ? point_on(edge, (begin - begin_of(k)) / whole) : edge.start;
            const Vec2d b = end < ends_[k] ? point_on(edge, (end - begin_of(k)) / whole) : edge.end;
            edge = between(edge, a, b);
        }
        out.push_back(edge);
    }
    return out;
}

ContourRun ContourRun::turned(double start) const
{
    std::vector<Edge> edges = part(start, length());
    const std::vector<Edge> rest = part(0, start);
    edges.insert(edges.end(), rest.begin(), rest.end());
    return ContourRun{std::move(edges)};
}

std::vector<Vec2d> points_along(const std::vector<Edge>& edges, const EdgeForm& form)
{
    std::vector<Vec2d> points;
    for (const Edge& edge : edges) {
        if (edge.turn == 0) {
            points.push_back(edge.end);
        } else {
            add_lines(edge, form, points);
        }
    }
    return points;
}

toolpath::EntryRun run_along(const std::vector<Edge>& edges, Vec3d start, const EdgeForm& form)
{
    toolpath::EntryRun run{start, {}};
    for (const Edge& edge : edges) {
        if (edge.turn != 0 && form.arcs) {
            run.pieces.push_back({{edge.end.x, edge.end.y, start.z}, edge.centre, edge.turn});
            continue;
        }
        for (const Vec2d p : points_along({edge}, form)) {
            run.pieces.push_back({{p.x, p.y, start.z}});
        }
    }
    return run;
}

void write_edges(const std::vector<Edge>& edges,
                 double z0,
                 double z1,
                 const EdgeForm& form,
                 ToolpathWriter& writer)
{
    const MoveKind kind = z1 < z0 ? MoveKind::kPlungingCut : MoveKind::kCut;
    double whole = 0;
    for (const Edge& edge : edges) {
        whole += offset::length(edge);
    }
    double gone = 0;
    for (const Edge& edge : edges) {
        const double size = offset::length(edge);
        const auto height = [&](double share) {
            return whole > 0 ? z0 + (z1 - z0) * (gone + share * size) / whole : z1;
        };
        if (edge.turn != 0 && form.arcs) {
            const double z = height(1);
            writer.arc(kind, {{edge.end.x, edge.end.y, z},
                              {edge.centre.x, edge.centre.y, z},
                              ArcPlane::kXY,
                              edge.turn < 0});
        } else {
            const std::vector<Vec2d> points = points_along({edge}, form);
            const auto n = static_cast<double>(points.size());
            for (std::size_t i = 0; i < points.size(); ++i) {
                writer.line(kind,
                            {points[i].x, points[i].y, height(static_cast<double>(i + 1) / n)});
            }
        }
        gone += size;
    }
}

}  // namespace cusp::prismatic
