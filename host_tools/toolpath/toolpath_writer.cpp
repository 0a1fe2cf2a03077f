// A helix consists of half turns. A ramp is the run itself, raised by an amount that falls with the
// distance travelled.
#include "host_tools/toolpath/toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::toolpath {

namespace {

constexpr double kEntrySlope = 0.0524;  // 3 degrees
constexpr double kHelixShare = 0.5;     // radius of an entry helix over the tool's
constexpr double kShallow = 0.05;       // mm: not worth a helix or a ramp
constexpr double kShortestRamp = 0.25;  // radii: a shorter run has no room for one

double plan_distance(Vec3d a, Vec3d b) { return std::hypot(b.x - a.x, b.y - a.y); }

}  // namespace

double plan_length(const std::vector<Vec3d>& points)
{
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        sum += plan_distance(points[i - 1], points[i]);
    }
    return sum;
}

std::vector<Vec3d> beginning(const std::vector<Vec3d>& points, double length)
{
    std::vector<Vec3d> out{points.front()};
    double left = length;
    for (std::size_t i = 1; i < points.size() && left > 0; ++i) {
        const double step = plan_distance(points[i - 1], points[i]);
        const double share = step > left ? left / step : 1.0;
        out.push_back(points[i - 1] + (points[i] - points[i - 1]) * share);
        left -= step;
    }
    return out;
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

void ToolpathWriter::enter(const std::vector<Vec3d>& run, double stock_top, const HelixFloor& floor)
{
    const Vec3d start = run.front();
    const double top = std::max(stock_top, start.z);
    if (settings_.kind == EntryKind::kPlunge || top - start.z <= kShallow) {
        line(MoveKind::kPlunge, start);
        return;
    }
    if (settings_.kind != EntryKind::kRamp) {
        line(MoveKind::kPlunge, {start.x, start.y, top});
        narrow_entries_ += helix(start, floor) ? 0 : 1;
        // Where the floor leaves no room for a helix, a ramp is used.
        if (at_.z - start.z <= kShallow) {
            line(MoveKind::kPlunge, start);
            return;
        }
    }
    if (plan_length(run) > kShortestRamp * settings_.tool_radius) {
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
        const Vec2d c = in_plan(start) + Vec2d{std::cos(angle), std::sin(angle)} * radius;
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

// Out and back along the run, as far as the slope needs, so that it ends at the start at depth.
void ToolpathWriter::ramp(const std::vector<Vec3d>& run)
{
    const double depth = at_.z - run.front().z;
    const double length = plan_length(run);
    const double drop = std::min(2 * length * kEntrySlope, settings_.max_drop);
    const int trips = std::max(1, static_cast<int>(std::ceil(depth / drop)));
    const std::vector<Vec3d> out = beginning(run, depth / (2 * trips * kEntrySlope));
    const double whole = 2 * trips * plan_length(out);
    double gone = 0;
    const auto go = [&](Vec3d p) {
        gone += plan_distance(at_, p);
        const double lift = depth * std::max(0.0, 1 - gone / whole);
        line(MoveKind::kPlunge, {p.x, p.y, p.z + lift});
    };
    for (int trip = 0; trip < trips; ++trip) {
        std::for_each(out.begin() + 1, out.end(), go);
        std::for_each(out.rbegin() + 1, out.rend(), go);
    }
    line(MoveKind::kPlunge, run.front());
}

}  // namespace cusp::toolpath
