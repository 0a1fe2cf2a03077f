// Bands start above exact heights by a margin for the surface between samples; then each move is
// proved clear.
#include "host_tools/cam/grid_pocket/cl_path_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "firmware/segmenter/arc_fitter.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/cl_path/cl_path_proof.hpp"
#include "host_tools/cam/cl_path/station_row.hpp"

namespace cusp::grid_pocket {

using cl_path::ClMove;
using cl_path::ClPath;
using cl_path::ClPathSettings;
using cl_path::drop_path;
using cl_path::PathFloor;
using cl_path::Station;
using cl_path::StationRow;
using cl_path::stations_along;
using cl_path::written;
using drop_cutter::DropCutter;
using nurbs::Surface;
using offset::Edge;
using offset::line_edge;
using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::MoveKind;
using toolpath::Tool;
using toolpath::ToolpathWriter;
using toolpath::ToolShape;

namespace {

// A move is proved clear if the bound of its clearance exceeds this.
constexpr double kProven = -1e-6;

// Shorter segments are ignored, mm.
constexpr double kNoLength = 1e-9;

// Distance allowed between moves and the straight line between corners, mm: rounding only.
constexpr double kStraight = 1e-6;

// Shares of an arc's tolerance by which the floor may rise above the chord between two stations. The
// rim of a flat end follows the floor itself, which may bend more.
constexpr double kBallBetweenStations = 0.06;
constexpr double kRimBetweenStations = 0.09;

// Sagitta of the chords that replace arcs in proofs, as a share of their tolerance.
constexpr double kArcSagitta = 0.025;

// Share of a two-sided tolerance for vertices; the rest is for the path between them.
constexpr double kTwoSided = 0.95;

// Heights below this are rounding of the G-code.
constexpr double kRounding = 2e-4;

// Moves stay this multiple of the drop cutter's accuracy inside their band, so that they can be
// proved: on a slope of 60 degrees half of a height is clearance.
constexpr double kReserve = 2.0;

Tool grown_tool(Tool tool, double by)
{
    tool.radius += by;
    tool.corner_radius += by;
    tool.shape = tool.shape == ToolShape::kFlat && by > 0 ? ToolShape::kBull : tool.shape;
    return tool;
}

// The tool, reduced on all sides.
Tool shrunk_tool(Tool tool, double by)
{
    tool.radius -= by;
    tool.corner_radius = std::max(0.0, tool.corner_radius - by);
    return tool;
}

}  // namespace

double band_height(const FollowSettings& settings)
{
    return settings.arcs ? std::max(settings.arc_tolerance, settings.tolerance)
                         : settings.tolerance;
}

double bend_radius(const Tool& tool) { return std::max(tool.corner_radius, tool.radius / 2); }

ClPathFitter::ClPathFitter(const std::vector<Surface>& floor,
                           const Tool& tool,
                           double allowance,
                           FollowSettings settings)
    : accuracy_{std::clamp(settings.tolerance / 40, 1e-4, 5e-4)},
      allowance_{allowance},
      settings_{settings}
{
    const Tool grown = grown_tool(tool, allowance);
    drop_cutter_ = std::make_shared<DropCutter>(floor, grown, accuracy_);
    if (settings_.both_sides && allowed_gouge() < grown.radius / 2) {
        gouge_cutter_ =
            std::make_shared<DropCutter>(floor, shrunk_tool(grown, allowed_gouge()), accuracy_);
    }
}

std::optional<double> ClPathFitter::height(Vec2d at) const
{
    const std::optional<DropCutter::ClPoint> cl = drop_cutter_->drop(at);
    return cl ? std::optional{cl->z + allowance_} : std::nullopt;
}

ClPathFitter ClPathFitter::above(double level) const
{
    ClPathFitter out = *this;
    // Tips are at written steps: a level between two of them would have no straight moves.
    out.min_z_ = written({0, 0, level}).z;
    out.gouge_bound_ = 0;
    return out;
}

double ClPathFitter::reserve() const { return kRounding + kReserve * accuracy_; }

// Beyond the floor, passes continue at its lowest height.
double ClPathFitter::path_height(Vec2d at) const
{
    return std::max(min_z_, height(at).value_or(lowest()));
}

double ClPathFitter::start_height(Vec2d at) const
{
    const double exact = path_height(at);
    const bool on_level = exact == min_z_;
    const double z = settings_.both_sides || on_level ? exact : exact + settings_.tolerance / 2;
    return written({at.x, at.y, z}).z;
}

double ClPathFitter::lowest_height(Vec2d at) const
{
    const double exact = path_height(at);
    return settings_.both_sides ? std::max(min_z_, exact - band_height(settings_)) : exact;
}

double ClPathFitter::move_clearance(Vec3d a, Vec3d b, double margin) const
{
    return floor().move_clearance(a, b, margin);
}

PathFloor ClPathFitter::floor() const
{
    PathFloor floor{*drop_cutter_, allowance_};
    if (gouge_cutter_) {
        floor.set_shrunk(*gouge_cutter_, allowed_gouge());
    }
    return floor;
}

// Lower bound, at most 0, of the clearance of a move that bulges by up to `sagitta` mm, in its
// vertical plane, from the straight line.
double ClPathFitter::bulged_clearance(Vec3d a, Vec3d b, double sagitta) const
{
    if (is_ball()) {
        return move_clearance(a, b, sagitta);
    }
    // Along the axis the bulge is longer on slopes.
    const double way = norm(in_plan(b) - in_plan(a));
    const double steep = way > 0 ? norm(b - a) / way : 1.0;
    const Vec3d down{0, 0, -sagitta * steep};
    return move_clearance(a + down, b + down);
}

void ClPathFitter::follow(ToolpathWriter& moves, const std::vector<Vec2d>& corners, MoveKind kind)
{
    for (std::size_t i = 1; settings_.arcs && i < corners.size(); ++i) {
        if (norm(corners[i] - corners[i - 1]) >= kNoLength &&
            !follow_with_arcs(moves, corners[i - 1], corners[i], kind)) {
            follow_in_lines(moves, {corners[i - 1], corners[i]}, kind);
        }
    }
    if (!settings_.arcs) {
        follow_in_lines(moves, corners, kind);
    }
}

ClPath ClPathFitter::lines(const std::vector<Vec2d>& corners, double start_z) const
{
    std::vector<Edge> plan;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        if (norm(corners[i] - corners[i - 1]) >= kNoLength) {
            plan.push_back(line_edge(corners[i - 1], corners[i]));
        }
    }
    if (plan.empty()) {
        ClPath none;
        none.start = {corners[0].x, corners[0].y, start_z};
        return none;
    }
    ClPathSettings settings;
    settings.start_z = start_z;
    settings.plan_tolerance = kStraight;
    settings.one_sided = !settings_.both_sides;
    settings.height_tolerance = settings_.tolerance - (settings_.both_sides ? reserve() : 0.0);
    settings.clearance_reserve = settings_.both_sides ? reserve() / 2 : reserve();
    settings.min_z = min_z_;
    settings.level_at_min_z = true;
    settings.spacing = settings_.sample;
    return drop_path(plan, floor(), settings);
}

void ClPathFitter::follow_in_lines(ToolpathWriter& moves,
                                   const std::vector<Vec2d>& corners,
                                   MoveKind kind)
{
    ClPath path = lines(corners, moves.at().z);
    if (path.moves.empty()) {
        return;
    }
    // The path is rounded to written steps; the next one starts at the corner itself.
    path.moves.back().end.x = corners.back().x;
    path.moves.back().end.y = corners.back().y;
    moves.line(kind, {moves.at().x, moves.at().y, path.start.z});
    for (const ClMove& move : path.moves) {
        moves.line(kind, move.end);
    }
    gouge_bound_ = std::max(gouge_bound_, -path.least_clearance);
}

// Lower bound of the clearance along the arc, at most 0; it may end early at a gouge that is too
// deep.
double ClPathFitter::arc_clearance(Vec3d from, const ArcTo& arc, double curvature) const
{
    // Chords of the arc, moved by the sagitta towards the arc's bulge if that is downward.
    const double radius = 1 / std::abs(curvature);
    const double chord = norm(arc.end - from);
    const double angle = 2 * elementary::asin(std::min(1.0, chord / 2 / radius));
    const int pieces = std::max(
        1, static_cast<int>(
               std::ceil(angle / std::sqrt(8 * kArcSagitta * settings_.arc_tolerance / radius))));
    const double sagitta = radius * (1 - elementary::cos(angle / pieces / 2));
    const double needed = curvature > 0 ? sagitta : 0;
    Vec3d spoke = from - arc.centre;
    const bool along_x = arc.plane == ArcPlane::kZX;
    double& across = along_x ? spoke.y : spoke.x;
    across = 0;
    const double start = elementary::atan2(spoke.z, along_x ? spoke.x : spoke.y);
    const Vec3d end_spoke = arc.end - arc.centre;
    double sweep = elementary::atan2(end_spoke.z, along_x ? end_spoke.x : end_spoke.y) - start;
    sweep += sweep > kPi ? -2 * kPi : sweep < -kPi ? 2 * kPi : 0;
    Vec3d before = from;
    double least = 0;
    for (int i = 1; i <= pieces; ++i) {
        const double a = start + sweep * i / pieces;
        Vec3d p = arc.end;
        if (i < pieces) {
            (along_x ? p.x : p.y) =
                (along_x ? arc.centre.x : arc.centre.y) + radius * elementary::cos(a);
            p.z = arc.centre.z + radius * elementary::sin(a);
        }
        least = std::min(least, bulged_clearance(before, p, needed));
        if (least < kProven - allowed_gouge()) {
            break;
        }
        before = p;
    }
    return least;
}

std::vector<Vec3d> ClPathFitter::arc_vertices(Vec2d a, Vec2d b) const
{
    const double tolerance = settings_.arc_tolerance;
    const PathFloor under = floor();
    const StationRow row =
        stations_along({line_edge(a, b)}, &under, {settings_.sample, kStraight, tolerance, true});
    const Vec2d way = (b - a) * (1 / norm(b - a));
    std::vector<Vec3d> out;
    for (const Station& station : row.stations) {
        double z = std::max(station.height, min_z_);
        if (!settings_.both_sides) {
            // The fitter measures perpendicular to the path: on slopes that distance is longer
            // along the axis.
            const double slope = dot(station.gradient, way);
            const double between = is_ball() ? kBallBetweenStations : kRimBetweenStations;
            const double steep = std::sqrt(1 + slope * slope);
            const double rise = between * steep * steep * steep;
            const double low = std::min(reserve() + rise * tolerance, tolerance / 3);
            const double height = tolerance / 2 * steep;
            z += std::max((low + tolerance) / 2, low + kArcSagitta * tolerance + height);
        }
        out.push_back({station.at.x, station.at.y, z});
    }
    return out;
}

bool ClPathFitter::follow_with_arcs(ToolpathWriter& moves, Vec2d a, Vec2d b, MoveKind kind)
{
    const bool along_x = std::abs(a.y - b.y) < 1e-9;
    if (!along_x && std::abs(a.x - b.x) >= 1e-9) {
        return false;
    }
    std::vector<Vec3d> vertices = arc_vertices(a, b);
    vertices.front() = moves.at();
    const double share = settings_.both_sides ? kTwoSided : 0.5;
    const double aside =
        std::max(settings_.arc_tolerance / 2,
                 std::min(share * settings_.arc_tolerance, settings_.arc_tolerance - reserve()));
    segmenter::FitSettings fit;
    fit.left = aside;
    fit.right = aside;
    fit.greatest_radius = settings_.max_arc_radius;
    std::vector<Vec3d> buffer(std::max<std::size_t>(vertices.size(), 4));
    segmenter::ArcFitter fitter{fit, {buffer.data(), buffer.size()}};
    fitter.start(vertices.front());
    std::for_each(vertices.begin() + 1, vertices.end(), [&](Vec3d v) { fitter.push(v); });
    fitter.finish();
    const double proven = kProven - allowed_gouge();
    for (segmenter::FittedMove piece; fitter.next(piece);) {
        const Vec3d from = moves.at();
        if (!piece.is_arc) {
            const double kept = move_clearance(from, piece.end);
            if (kept >= proven) {
                gouge_bound_ = std::max(gouge_bound_, settings_.both_sides ? -kept : 0.0);
                moves.line(kind, piece.end);
            } else {
                follow_in_lines(moves, {in_plan(from), in_plan(piece.end)}, kind);
            }
            continue;
        }
        const Vec3d centre =
            along_x ? Vec3d{from.x + piece.second_offset, from.y, from.z + piece.first_offset}
                    : Vec3d{from.x, from.y + piece.first_offset, from.z + piece.second_offset};
        const ArcTo arc{piece.end, centre, along_x ? ArcPlane::kZX : ArcPlane::kYZ,
                        piece.clockwise};
        const double radius = norm(centre - from);
        const double curvature = (centre.z > (from.z + piece.end.z) / 2 ? 1 : -1) / radius;
        const double kept = arc_clearance(from, arc, curvature);
        if (kept >= proven) {
            gouge_bound_ = std::max(gouge_bound_, settings_.both_sides ? -kept : 0.0);
            moves.arc(kind, arc);
        } else {
            follow_in_lines(moves, {in_plan(from), in_plan(piece.end)}, kind);
        }
    }
    return true;
}

bool ClPathFitter::in_band(Vec2d at, double z) const
{
    const double exact = path_height(at);
    if (exact == min_z_) {
        return z == min_z_;
    }
    const double lowest = settings_.both_sides ? exact - settings_.tolerance : exact + reserve();
    return z >= std::max(min_z_, lowest) && z <= exact + settings_.tolerance;
}

bool ClPathFitter::follow_level_arc(ToolpathWriter& moves, const Edge& arc, MoveKind kind)
{
    constexpr double kShortestArc = 0.05;  // mm
    const double turned = sweep(arc);
    if (!settings_.arcs || arc.turn == 0 || arc.radius > settings_.max_arc_radius ||
        length(arc) < kShortestArc) {
        return false;
    }
    const double z = moves.at().z;
    const double sagitta = kArcSagitta * settings_.tolerance;
    const double step = 2 * std::sqrt(2 * std::min(sagitta / arc.radius, 0.5));
    const int pieces =
        1 + static_cast<int>(std::max(turned / step, length(arc) / settings_.sample));
    const double proven = kProven - allowed_gouge();
    Vec3d before = moves.at();
    double least = 0;
    for (int i = 1; i <= pieces; ++i) {
        const Vec2d at = i < pieces ? point_on(arc, static_cast<double>(i) / pieces) : arc.end;
        const Vec3d next{at.x, at.y, z};
        least = std::min(least,
                         in_band(at, z) ? move_clearance(before, next, sagitta) : 2 * proven - 1);
        if (least < proven) {
            return false;
        }
        before = next;
    }
    gouge_bound_ = std::max(gouge_bound_, settings_.both_sides ? -least : 0.0);
    const Vec3d centre{arc.centre.x, arc.centre.y, z};
    moves.arc(kind, {{arc.end.x, arc.end.y, z}, centre, ArcPlane::kXY, arc.turn < 0});
    return true;
}

std::vector<Vec3d> ClPathFitter::chords(const std::vector<Vec2d>& corners, double length) const
{
    std::vector<Vec2d> plan{corners[0]};
    for (std::size_t i = 1; i < corners.size() && length > 0; ++i) {
        const double whole = norm(corners[i] - corners[i - 1]);
        if (whole >= kNoLength) {
            const double share = std::min(1.0, length / whole);
            plan.push_back(corners[i - 1] + (corners[i] - corners[i - 1]) * share);
        }
        length -= whole;
    }
    const ClPath path = lines(plan, start_height(corners[0]));
    std::vector<Vec3d> out{path.start};
    for (const ClMove& move : path.moves) {
        out.push_back(move.end);
    }
    return out;
}

}  // namespace cusp::grid_pocket
