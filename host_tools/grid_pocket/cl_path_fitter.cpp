// Bands start above exact heights by a margin for the surface between samples; then each move is
// proved clear.
#include "host_tools/grid_pocket/cl_path_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "firmware/segmenter/arc_fitter.hpp"

namespace cusp::grid_pocket {

using drop_cutter::DropCutter;
using nurbs::Surface;
using offset::Edge;
using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::MoveKind;
using toolpath::Tool;
using toolpath::ToolpathWriter;
using toolpath::ToolShape;

namespace {

// A move is proved clear if the bound of its clearance exceeds this.
constexpr double kProven = -1e-6;

// Shorter moves are raised instead of divided.
constexpr double kShortestPiece = 0.02;

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
    // A tool grown on all sides by the allowance has its tip that much lower.
    const std::optional<DropCutter::ClPoint> cl = drop_cutter_->drop(at);
    return cl ? std::optional{cl->z + allowance_} : std::nullopt;
}

ClPathFitter ClPathFitter::above(double level) const
{
    ClPathFitter out = *this;
    out.min_z_ = level;
    out.gouge_bound_ = 0;
    return out;
}

double ClPathFitter::reserve() const { return kRounding + kReserve * accuracy_; }

double ClPathFitter::used_of(double tolerance) const
{
    return std::max(kTwoSided * tolerance - reserve(), tolerance / 2);
}

// Beyond the floor, passes continue at its lowest height.
double ClPathFitter::path_height(Vec2d at) const
{
    return std::max(min_z_, height(at).value_or(lowest()));
}

double ClPathFitter::start_height(Vec2d at) const
{
    const double exact = path_height(at);
    const bool on_level = exact == min_z_;
    return settings_.both_sides || on_level ? exact : exact + settings_.tolerance / 2;
}

double ClPathFitter::lowest_height(Vec2d at) const
{
    const double exact = path_height(at);
    return settings_.both_sides ? std::max(min_z_, exact - band_height(settings_)) : exact;
}

double ClPathFitter::move_clearance(Vec3d a, Vec3d b, double margin) const
{
    const Vec3d down{0, 0, -allowance_};
    const double clear = drop_cutter_->move_clearance(a + down, b + down, margin);
    const double allowed = allowed_gouge();
    if (!gouge_cutter_ || clear >= kProven - allowed) {
        return clear;
    }
    // The bound of a deep gouge is accurate to a tenth only. If a tool reduced by the allowed gouge
    // is clear, the tool gouges by no more than that.
    const Vec3d up{0, 0, allowed - allowance_};
    return std::max(clear, gouge_cutter_->move_clearance(a + up, b + up, margin) - allowed);
}

std::vector<BandPoint> ClPathFitter::band(Vec2d a, Vec2d b, double tolerance) const
{
    const double length = norm(b - a);
    const int count = std::max(1, static_cast<int>(std::ceil(length / settings_.sample - 1e-9)));
    const double step = length / count;
    std::vector<double> heights;
    for (int i = 0; i <= count; ++i) {
        heights.push_back(path_height(a + (b - a) * (static_cast<double>(i) / count)));
    }
    std::vector<BandPoint> out;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double z = heights[i];
        if (settings_.both_sides) {
            const double used = used_of(tolerance);
            out.push_back({static_cast<double>(i) * step, std::max(min_z_, z - used), z + used});
            continue;
        }
        if (z == min_z_ && (i == 0 || heights[i - 1] == min_z_) &&
            (i + 1 == heights.size() || heights[i + 1] == min_z_)) {
            out.push_back({static_cast<double>(i) * step, z, z});
            continue;
        }
        // The exact height is an upper envelope of arcs of the tool's corner: between two places it
        // rises above their chord by no more than such an arc.
        const double before = i > 0 ? std::abs(z - heights[i - 1]) / step : 0.0;
        const double after = i + 1 < heights.size() ? std::abs(heights[i + 1] - z) / step : 0.0;
        const double slope = std::max(before, after);
        const double bend = std::pow(1 + slope * slope, 1.5) / bend_radius(drop_cutter_->tool());
        const double margin = std::min(step * step / 8 * bend + reserve(), tolerance / 3);
        out.push_back({static_cast<double>(i) * step, z + margin, z + tolerance});
    }
    return out;
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

void ClPathFitter::chord(ToolpathWriter& moves, Vec3d end, MoveKind kind, int depth)
{
    const Vec3d from = moves.at();
    const double proven = kProven - allowed_gouge();
    const double kept = bulged_clearance(from, end, 0);
    if (kept >= proven) {
        gouge_bound_ = std::max(gouge_bound_, settings_.both_sides ? -kept : 0.0);
        moves.line(kind, end);
        return;
    }
    constexpr int kDeepest = 12;
    if (depth < kDeepest && norm(end - from) > kShortestPiece) {
        Vec3d middle = (from + end) * 0.5;
        const double exact = std::max(min_z_, height(in_plan(middle)).value_or(middle.z));
        middle.z = std::max(middle.z, exact + reserve());
        chord(moves, middle, kind, depth + 1);
        chord(moves, end, kind, depth + 1);
        return;
    }
    // On slopes, raising along the axis adds less clearance than its length, so it is doubled until
    // it suffices.
    constexpr int kMostLifts = 10;
    Vec3d lift{0, 0, (proven - kept) * 1.5};
    double left = bulged_clearance(from + lift, end + lift, 0);
    for (int i = 0; i < kMostLifts && left < proven; ++i) {
        lift.z *= 2;
        left = bulged_clearance(from + lift, end + lift, 0);
    }
    moves.line(kind, from + lift);
    moves.line(kind, end + lift);
    gouge_bound_ = std::max(gouge_bound_, -left);
}

void ClPathFitter::follow_segment(ToolpathWriter& moves, Vec2d a, Vec2d b, MoveKind kind)
{
    std::vector<BandPoint> places = band(a, b, settings_.tolerance);
    const double z = moves.at().z;
    places.front().low = std::min(places.front().low, z);
    places.front().high = std::max(places.front().high, z);
    const auto point = [&, length = norm(b - a)](const ProfilePoint& p) {
        const Vec2d at = a + (b - a) * (p.s / length);
        return Vec3d{at.x, at.y, p.z};
    };
    std::vector<ProfilePoint> points = fit_chords(places, z);
    constexpr int kMostRaises = 6;
    for (int i = 0; i < kMostRaises && raise_band(places, points, point); ++i) {
        points = fit_chords(places, z);
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
        chord(moves, point(points[i]), kind, 0);
    }
}

// The rim of a flat end follows the floor itself, which may bend more between samples than the band
// assumes. Raises the band below each chord by the shortfall of clearance; returns whether any was
// raised.
bool ClPathFitter::raise_band(std::vector<BandPoint>& places,
                              const std::vector<ProfilePoint>& points,
                              const std::function<Vec3d(const ProfilePoint&)>& point) const
{
    constexpr double kRaise = 1.5;
    if (is_ball()) {
        return false;
    }
    const double proven = kProven - allowed_gouge();
    bool raised = false;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double lacks = proven - move_clearance(point(points[i - 1]), point(points[i]));
        for (BandPoint& place : places) {
            const bool under = place.s >= points[i - 1].s && place.s <= points[i].s;
            if (under && lacks > 0 && lacks < settings_.tolerance && place.low < place.high) {
                place.low = std::min(place.low + kRaise * lacks, place.high);
                raised = true;
            }
        }
    }
    return raised;
}

void ClPathFitter::follow(ToolpathWriter& moves, const std::vector<Vec2d>& corners, MoveKind kind)
{
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const Vec2d a = corners[i - 1];
        const Vec2d b = corners[i];
        if (norm(b - a) < 1e-9) {
            continue;
        }
        if (!settings_.arcs || !follow_with_arcs(moves, a, b, kind)) {
            follow_segment(moves, a, b, kind);
        }
    }
}

// Lower bound of the clearance along the arc, at most 0; it may end early at a gouge that is too
// deep.
double ClPathFitter::arc_clearance(Vec3d from, const ArcTo& arc, double curvature) const
{
    // Chords of the arc, moved by the sagitta towards the arc's bulge if that is downward.
    const double radius = 1 / std::abs(curvature);
    const double chord = norm(arc.end - from);
    const double angle = 2 * std::asin(std::min(1.0, chord / 2 / radius));
    const int pieces = std::max(
        1, static_cast<int>(
               std::ceil(angle / std::sqrt(8 * kArcSagitta * settings_.arc_tolerance / radius))));
    const double sagitta = radius * (1 - std::cos(angle / pieces / 2));
    const double needed = curvature > 0 ? sagitta : 0;
    Vec3d spoke = from - arc.centre;
    const bool along_x = arc.plane == ArcPlane::kZX;
    double& across = along_x ? spoke.y : spoke.x;
    across = 0;
    const double start = std::atan2(spoke.z, along_x ? spoke.x : spoke.y);
    const Vec3d end_spoke = arc.end - arc.centre;
    double sweep = std::atan2(end_spoke.z, along_x ? end_spoke.x : end_spoke.y) - start;
    sweep += sweep > kPi ? -2 * kPi : sweep < -kPi ? 2 * kPi : 0;
    Vec3d before = from;
    double least = 0;
    for (int i = 1; i <= pieces; ++i) {
        const double a = start + sweep * i / pieces;
        Vec3d p = arc.end;
        if (i < pieces) {
            (along_x ? p.x : p.y) = (along_x ? arc.centre.x : arc.centre.y) + radius * std::cos(a);
            p.z = arc.centre.z + radius * std::sin(a);
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
    const std::vector<BandPoint> places = band(a, b, settings_.arc_tolerance);
    const double length = norm(b - a);
    std::vector<Vec3d> out;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec2d at = a + (b - a) * (places[i].s / length);
        double z = (places[i].low + places[i].high) / 2;
        if (!settings_.both_sides) {
            // The fitter measures perpendicular to the path: on slopes that distance is longer
            // along the axis.
            const BandPoint& before = places[i > 0 ? i - 1 : i];
            const BandPoint& after = places[i + 1 < places.size() ? i + 1 : i];
            const double slope = (after.high - before.high) / (after.s - before.s);
            const double height = settings_.arc_tolerance / 2 * std::sqrt(1 + slope * slope);
            z = std::max(z, places[i].low + kArcSagitta * settings_.arc_tolerance + height);
        }
        out.push_back({at.x, at.y, z});
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
    for (segmenter::FittedMove piece; fitter.next(piece);) {
        if (!piece.is_arc) {
            chord(moves, piece.end, kind, 0);
            continue;
        }
        const Vec3d from = moves.at();
        const Vec3d centre =
            along_x ? Vec3d{from.x + piece.second_offset, from.y, from.z + piece.first_offset}
                    : Vec3d{from.x, from.y + piece.first_offset, from.z + piece.second_offset};
        const ArcTo arc{piece.end, centre, along_x ? ArcPlane::kZX : ArcPlane::kYZ,
                        piece.clockwise};
        const double radius = norm(centre - from);
        const double curvature = (centre.z > (from.z + piece.end.z) / 2 ? 1 : -1) / radius;
        const double kept = arc_clearance(from, arc, curvature);
        if (kept >= kProven - allowed_gouge()) {
            gouge_bound_ = std::max(gouge_bound_, settings_.both_sides ? -kept : 0.0);
            moves.arc(kind, arc);
        } else {
            follow_segment(moves, in_plan(from), in_plan(piece.end), kind);
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
    std::vector<Vec3d> out{{corners[0].x, corners[0].y, start_height(corners[0])}};
    for (std::size_t i = 1; i < corners.size() && length > 0; ++i) {
        const Vec2d a = corners[i - 1];
        const double whole = norm(corners[i] - a);
        if (whole < 1e-9) {
            continue;
        }
        const Vec2d b = a + (corners[i] - a) * std::min(1.0, length / whole);
        std::vector<BandPoint> places = band(a, b, settings_.tolerance);
        places.front().low = std::min(places.front().low, out.back().z);
        places.front().high = std::max(places.front().high, out.back().z);
        const double step = norm(b - a);
        const std::vector<ProfilePoint> points = fit_chords(places, out.back().z);
        for (std::size_t k = 1; k < points.size(); ++k) {
            const Vec2d at = a + (b - a) * (points[k].s / step);
            out.push_back({at.x, at.y, points[k].z});
        }
        length -= whole;
    }
    return out;
}

}  // namespace cusp::grid_pocket
