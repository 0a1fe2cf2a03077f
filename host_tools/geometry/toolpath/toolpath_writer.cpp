// A helix consists of half turns. A ramp is the run itself, raised by an amount that falls with the
// distance travelled.
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::toolpath {

namespace {

constexpr double kEntrySlope = 0.0524;  // 3 degrees
constexpr double kHelixShare = 0.5;     // radius of an entry helix over the tool's
constexpr double kShallow = 0.05;       // mm: not worth a helix or a ramp
constexpr double kShortestRamp = 0.25;  // radii: a shorter run has no room for one

// True if it ends where it starts, with a way round between.
bool is_round(const EntryRun& run)
{
    constexpr double kSamePoint = 1e-6;   // mm in plan
    constexpr double kLeastRound = 0.01;  // mm
    return norm(in_plan(run.end()) - in_plan(run.start)) < kSamePoint &&
           plan_length(run) > kLeastRound;
}

}  // namespace

bool goes_round(double length, double tool_radius)
{
    return length * kEntrySlope < kLeastTurn * tool_radius;
}

void ToolpathWriter::line(MoveKind kind, Vec3d end)
{
    if (!started_ || end != at_) {
        add({kind, LineTo{end}});
    }
}

void ToolpathWriter::add(const ToolMove& move)
{
    moves_.push_back(move);
    at_ = end_of(move);
    started_ = true;
}

void ToolpathWriter::retract()
{
    if (started_ && !is_retracted()) {
        line(MoveKind::kRapid, {at_.x, at_.y, settings_.clearance_z});
        ++retracts_;
    }
}

void ToolpathWriter::approach(Vec2d place, double z)
{
    retract();
    line(MoveKind::kRapid, {place.x, place.y, settings_.clearance_z});
    if (z < settings_.clearance_z) {
        line(MoveKind::kRapid, {place.x, place.y, z});
    }
}

void ToolpathWriter::enter(const EntryRun& run, double stock_top, const HelixFloor& floor)
{
    const Vec3d start = run.start;
    const double top = std::max(stock_top, start.z);
    if (settings_.kind == EntryKind::kPlunge || top - start.z <= kShallow) {
        line(MoveKind::kPlunge, start);
        return;
    }
    if (settings_.kind != EntryKind::kRamp) {
        line(MoveKind::kPlunge, {start.x, start.y, top});
        narrow_entries_ += helix(start, floor) ? 0 : 1;
        // If the floor leaves no room for a helix, a ramp is used.
        if (at_.z - start.z <= kShallow) {
            line(MoveKind::kPlunge, start);
            return;
        }
    }
    if (plan_length(run) > kShortestRamp * settings_.tool_radius || is_round(run)) {
        line(MoveKind::kPlunge, {start.x, start.y, std::min(at_.z, top)});
        ramp(run);
        return;
    }
    ++steep_plunges_;
    line(MoveKind::kPlunge, start);
}

// Among the circles through the start, the one where the tip gets lowest.
bool ToolpathWriter::helix(Vec3d start, const HelixFloor& floor)
{
    constexpr int kSides = 16;
    const double radius = kHelixShare * settings_.tool_radius;
    std::optional<double> lowest;
    Vec2d centre{};
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * kPi * i / kSides;
        const Vec2d c =
            in_plan(start) + Vec2d{elementary::cos(angle), elementary::sin(angle)} * radius;
        const std::optional<double> z = floor(c, radius);
        if (z && (!lowest || *z < *lowest)) {
            lowest = z;
            centre = c;
        }
    }
    const double from = at_.z;
    const double end = std::max(start.z, lowest.value_or(from));
    const double depth = from - end;
    if (depth <= kShallow) {
        return false;
    }
    // Half turns, then a level turn that clears what the last slope left.
    const double drop = std::min(2 * kPi * radius * kEntrySlope, settings_.max_drop);
    const int halves = 2 * std::max(1, static_cast<int>(std::ceil(depth / drop)));
    const Vec2d opposite = centre * 2.0 - in_plan(start);
    for (int i = 1; i <= halves + 2; ++i) {
        const Vec2d p = i % 2 == 0 ? in_plan(start) : opposite;
        const double z = i < halves ? from - depth * i / halves : end;
        arc(MoveKind::kPlunge, {{p.x, p.y, z}, {centre.x, centre.y, z}, ArcPlane::kXY, false});
    }
    ++helices_;
    return true;
}

// The run at heights that fall evenly with the distance travelled, from `depth` above it to nothing.
//
// whole  mm of the slope; gone: of it so far
void ToolpathWriter::go_along(const EntryRun& run, double depth, double whole, double& gone)
{
    Vec3d from = run.start;
    for (const RunPiece& piece : run.pieces) {
        gone += plan_length(from, piece);
        const double lift = depth * std::max(0.0, 1 - gone / whole);
        const Vec3d end{piece.end.x, piece.end.y, piece.end.z + lift};
        if (piece.turn == 0) {
            line(MoveKind::kPlunge, end);
        } else {
            arc(MoveKind::kPlunge,
                {end, {piece.centre.x, piece.centre.y, end.z}, ArcPlane::kXY, piece.turn < 0});
        }
        from = piece.end;
    }
}

// Out and back along the run, as far as the slope needs, so that it ends at the start at depth; round and
// round where it is closed and short.
void ToolpathWriter::ramp(const EntryRun& run)
{
    const double depth = at_.z - run.start.z;
    const double length = plan_length(run);
    const double turn = std::min(kLeastTurn * settings_.tool_radius, settings_.max_drop);
    double gone = 0;
    if (is_round(run) && goes_round(length, settings_.tool_radius)) {
        const int turns = std::max(1, static_cast<int>(std::ceil(depth / turn)));
        for (int i = 0; i < turns; ++i) {
            go_along(run, depth, turns * length, gone);
        }
    } else {
        const double drop = std::min(2 * length * kEntrySlope, settings_.max_drop);
        const int trips = std::max(1, static_cast<int>(std::ceil(depth / drop)));
        const EntryRun trip = there_and_back(run, depth / (trips * kEntrySlope));
        const double whole = trips * plan_length(trip);
        for (int i = 0; i < trips; ++i) {
            go_along(trip, depth, whole, gone);
        }
    }
    line(MoveKind::kPlunge, run.start);
}

}  // namespace cusp::toolpath
