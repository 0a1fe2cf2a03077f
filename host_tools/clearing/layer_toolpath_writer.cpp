// Ways in: straight down where no metal is, else a helix where it has room, else a ramp along the
// run.
#include "host_tools/clearing/layer_toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::clearing {

using job::EntryKind;
using offset::Edge;
using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;

namespace {

constexpr double kAboveMetal = 1.0;     // mm: rapids go no nearer
constexpr double kEntrySlope = 0.0524;  // 3 degrees
constexpr double kHelixShare = 0.5;     // radius of an entry helix over the cutter's
constexpr double kLongLink = 8.0;  // radii: a link longer than this and twice the lift is no gain

// Points along the run, so close on arcs that straight moves between them stay within the
// tolerance.
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

double length_of(const std::vector<Vec2d>& points)
{
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        sum += norm(points[i] - points[i - 1]);
    }
    return sum;
}

}  // namespace

void LayerToolpathWriter::line(MoveKind kind, Vec3d end)
{
    if (!(end == at_) || !started_) {
        path_.moves.push_back({kind, LineTo{end}});
        at_ = end;
    }
}

void LayerToolpathWriter::retract()
{
    if (started_ && at_.z < settings_.clearance_z) {
        line(MoveKind::kRapid, {at_.x, at_.y, settings_.clearance_z});
        ++retracts_;
    }
}

void LayerToolpathWriter::cut(const Edge& edge, double z)
{
    // Rounded to G-code's digits a short arc could close to a full circle.
    constexpr double kShortArc = 0.02;
    if (edge.turn == 0 || !settings_.arcs || norm(edge.end - edge.start) < kShortArc) {
        for (const Vec2d& p : polyline({edge}, settings_.chord_tolerance)) {
            line(MoveKind::kCut, {p.x, p.y, z});
        }
        return;
    }
    const Vec3d end{edge.end.x, edge.end.y, z};
    path_.moves.push_back(
        {MoveKind::kCut,
         ArcTo{end, {edge.centre.x, edge.centre.y, z}, ArcPlane::kXY, edge.turn < 0}});
    at_ = end;
}

bool LayerToolpathWriter::link(Vec2d start, const LayerSpace& layer)
{
    if (!started_ || !layer.cleared_above || at_.z > layer.top + kAboveMetal) {
        return false;
    }
    const double lift = settings_.clearance_z - layer.top;
    const double way = norm(start - place());
    if (way > 2 * lift + kLongLink * layer.radius || !layer.cleared_above(place(), start)) {
        return false;
    }
    if (at_.z < layer.top) {
        line(MoveKind::kLink, {at_.x, at_.y, layer.top});
    }
    line(MoveKind::kLink, {start.x, start.y, layer.top});
    return true;
}

bool LayerToolpathWriter::helix(Vec2d start, const LayerSpace& layer)
{
    const double radius = kHelixShare * layer.radius;
    Vec2d centre{};
    bool found = false;
    for (int i = 0; i < 16 && !found; ++i) {
        const double angle = i * (kPi / 8);
        centre = start + Vec2d{std::cos(angle), std::sin(angle)} * radius;
        found = layer.has_room(centre, radius);
    }
    if (!found) {
        return false;
    }
    const double depth = at_.z - layer.bottom;
    const int halves =
        2 * std::max(1, static_cast<int>(std::ceil(depth / (2 * kPi * radius * kEntrySlope))));
    const double from = at_.z;
    for (int i = 1; i <= halves + 2; ++i) {
        const Vec2d p = i % 2 == 0 ? start : centre * 2.0 - start;
        const double z = std::max(layer.bottom, from - depth * i / halves);
        at_ = {p.x, p.y, z};
        path_.moves.push_back(
            {MoveKind::kPlunge, ArcTo{at_, {centre.x, centre.y, z}, ArcPlane::kXY, false}});
    }
    return true;
}

void LayerToolpathWriter::ramp(const std::vector<Vec2d>& way,
                               double length,
                               double from,
                               double bottom)
{
    // Out and back along the run, losing height all the way, so that it ends at its start at depth.
    const double depth = from - bottom;
    const int trips = std::max(1, static_cast<int>(std::ceil(depth / (2 * length * kEntrySlope))));
    const double reach = std::min(length, depth / (2 * trips * kEntrySlope));
    std::vector<Vec2d> out{way.front()};
    double gone = 0;
    for (std::size_t i = 1; i < way.size() && gone < reach; ++i) {
        const double step = norm(way[i] - way[i - 1]);
        const double share = std::min(1.0, (reach - gone) / std::max(step, 1e-12));
        out.push_back(way[i - 1] + (way[i] - way[i - 1]) * share);
        gone += step * share;
    }
    double z = from;
    const double fall = depth / (2 * trips * gone);
    const auto go = [&](Vec2d p) {
        z = std::max(bottom, z - norm(p - place()) * fall);
        line(MoveKind::kPlunge, {p.x, p.y, z});
    };
    for (int trip = 0; trip < trips; ++trip) {
        std::for_each(out.begin() + 1, out.end(), go);
        std::for_each(out.rbegin() + 1, out.rend(), go);
    }
    line(MoveKind::kPlunge, {way.front().x, way.front().y, bottom});
}

void LayerToolpathWriter::enter(const LayerRun& run, const LayerSpace& layer)
{
    const Vec2d start = run.edges.front().start;
    const bool open = run.starts_in_cleared_stock || layer.beside_stock(start);
    const double stock = open ? layer.bottom : layer.top;
    const double down = std::min(stock + layer.scallop_height + kAboveMetal, settings_.clearance_z);
    if (at_.z > down) {
        line(MoveKind::kRapid, {start.x, start.y, down});
    }
    if (!open && settings_.entry != EntryKind::kPlunge) {
        line(MoveKind::kPlunge, {start.x, start.y, std::min(at_.z, stock)});
        const bool wants_helix =
            settings_.entry == EntryKind::kAuto || settings_.entry == EntryKind::kHelix;
        if (wants_helix && helix(start, layer)) {
            return;
        }
        const std::vector<Vec2d> way = polyline(run.edges, settings_.chord_tolerance);
        const double length = length_of(way);
        if (length > layer.radius / 4) {
            ramp(way, length, at_.z, layer.bottom);
            return;
        }
        ++steep_plunges_;
    }
    line(MoveKind::kPlunge, {start.x, start.y, layer.bottom});
}

void LayerToolpathWriter::add(const LayerRun& run, const LayerSpace& layer)
{
    const Vec2d start = run.edges.front().start;
    const bool stays = started_ && at_.z == layer.bottom && norm(start - place()) < 1e-6;
    if (!stays) {
        if (!link(start, layer)) {
            retract();
            line(MoveKind::kRapid, {start.x, start.y, settings_.clearance_z});
            started_ = true;
        }
        enter(run, layer);
    }
    for (const Edge& edge : run.edges) {
        cut(edge, layer.bottom);
    }
}

}  // namespace cusp::clearing
