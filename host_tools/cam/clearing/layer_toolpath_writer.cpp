// Links to a run through stock cleared by the layer above, or retracts; then enters and cuts along
// it.
#include "host_tools/cam/clearing/layer_toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::clearing {

using offset::Edge;
using toolpath::ArcPlane;
using toolpath::kRapidClearance;
using toolpath::MoveKind;

namespace {

constexpr double kSamePlace = 1e-6;  // mm
constexpr double kLongLink = 8.0;  // radii: longer links than this and twice the lift save nothing

// Points along the run; on arcs their chords are within the tolerance.
std::vector<Vec2d> polyline(const std::vector<Edge>& edges, double tolerance)
{
    std::vector<Vec2d> out{edges.front().start};
    for (const Edge& edge : edges) {
        int pieces = 1;
        if (edge.turn != 0) {
            const double step = 2 * std::sqrt(2 * std::min(tolerance / edge.radius, 0.5));
            pieces = static_cast<int>(std::ceil(sweep(edge) / step));
        }
        for (int i = 1; i < pieces; ++i) {
            out.push_back(point_on(edge, static_cast<double>(i) / pieces));
        }
        out.push_back(edge.end);
    }
    return out;
}

}  // namespace

void LayerToolpathWriter::cut(const Edge& edge, double z)
{
    // Rounded to G-code's digits a short arc could close to a full circle.
    constexpr double kShortArc = 0.02;
    if (edge.turn == 0 || !settings_.arcs || norm(edge.end - edge.start) < kShortArc) {
        for (const Vec2d& p : polyline({edge}, settings_.chord_tolerance)) {
            writer_.line(MoveKind::kCut, {p.x, p.y, z});
        }
        return;
    }
    const Vec3d end{edge.end.x, edge.end.y, z};
    writer_.arc(MoveKind::kCut,
                {end, {edge.centre.x, edge.centre.y, z}, ArcPlane::kXY, edge.turn < 0});
}

bool LayerToolpathWriter::link(Vec2d start, const LayerSpace& layer)
{
    const double z = writer_.at().z;
    if (!started() || !layer.cleared_above || z > layer.top + kRapidClearance) {
        return false;
    }
    const double lift = settings_.clearance_z - layer.top;
    const double way = norm(start - place());
    if (way > 2 * lift + kLongLink * layer.radius || !layer.cleared_above(place(), start)) {
        return false;
    }
    if (z < layer.top) {
        writer_.line(MoveKind::kLink, {place().x, place().y, layer.top});
    }
    writer_.line(MoveKind::kLink, {start.x, start.y, layer.top});
    return true;
}

void LayerToolpathWriter::enter(const LayerRun& run, const LayerSpace& layer)
{
    const Vec2d start = run.edges.front().start;
    const bool open = run.starts_in_cleared_stock || layer.beside_stock(start);
    const double stock = open ? layer.bottom : layer.top;
    const double down =
        std::min(stock + layer.scallop_height + kRapidClearance, settings_.clearance_z);
    if (writer_.at().z > down) {
        writer_.line(MoveKind::kRapid, {start.x, start.y, down});
    }
    std::vector<Vec3d> points;
    for (const Vec2d p : polyline(run.edges, settings_.chord_tolerance)) {
        points.push_back({p.x, p.y, layer.bottom});
    }
    writer_.enter(points, stock, [&layer](Vec2d centre, double radius) {
        return layer.has_room(centre, radius) ? std::optional{layer.bottom} : std::nullopt;
    });
}

void LayerToolpathWriter::add(const LayerRun& run, const LayerSpace& layer)
{
    const Vec2d start = run.edges.front().start;
    const bool stays =
        started() && writer_.at().z == layer.bottom && norm(start - place()) < kSamePlace;
    if (!stays) {
        if (!link(start, layer)) {
            writer_.approach(start, settings_.clearance_z);
        }
        enter(run, layer);
    }
    for (const Edge& edge : run.edges) {
        cut(edge, layer.bottom);
    }
}

}  // namespace cusp::clearing
