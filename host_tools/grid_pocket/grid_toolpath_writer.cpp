// A ramp is the run itself, lifted by an amount that falls with the way gone.
#include "host_tools/grid_pocket/grid_toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::grid_pocket {

using job::EntryKind;
using toolpath::ArcPlane;
using toolpath::MoveKind;

namespace {

constexpr double kAboveMetal = 1.0;     // mm: rapids go no nearer
constexpr double kEntrySlope = 0.0524;  // 3 degrees
constexpr double kHelixShare = 0.5;     // radius of an entry helix over the cutter's
constexpr double kShallow = 0.05;       // mm: not worth a ramp

double plan_length(const std::vector<Vec3d>& way)
{
    double sum = 0;
    for (std::size_t i = 1; i < way.size(); ++i) {
        sum += std::hypot(way[i].x - way[i - 1].x, way[i].y - way[i - 1].y);
    }
    return sum;
}

}  // namespace

void GridToolpathWriter::retract()
{
    if (tip_.started() && !is_retracted()) {
        const Vec3d at = tip_.at();
        tip_.line(MoveKind::kRapid, {at.x, at.y, clearance_z_});
        ++retracts_;
    }
}

void GridToolpathWriter::enter(const ClPathFitter& floor,
                               const std::vector<Vec2d>& corners,
                               double stock_top,
                               bool link,
                               const CircleFloor& circle)
{
    const std::vector<Vec3d> way = floor.chords(corners, ramp_length());
    const Vec3d start = way.front();
    const double over = std::max(stock_top, start.z);
    if (link && over + kAboveMetal < clearance_z_) {
        const Vec3d at = tip_.at();
        tip_.line(MoveKind::kLink, {at.x, at.y, over + kAboveMetal});
        tip_.line(MoveKind::kLink, {start.x, start.y, over + kAboveMetal});
    } else {
        retract();
        tip_.line(MoveKind::kRapid, {start.x, start.y, clearance_z_});
        if (over + kAboveMetal < clearance_z_) {
            tip_.line(MoveKind::kRapid, {start.x, start.y, over + kAboveMetal});
        }
    }
    go_down(way, stock_top, circle);
}

void GridToolpathWriter::descend(const ClPathFitter& floor,
                                 const std::vector<Vec2d>& corners,
                                 double stock_top,
                                 const CircleFloor& circle)
{
    go_down(floor.chords(corners, ramp_length()), stock_top, circle);
}

void GridToolpathWriter::go_down(const std::vector<Vec3d>& way,
                                 double stock_top,
                                 const CircleFloor& circle)
{
    const Vec3d start = way.front();
    const double over = std::max(stock_top, start.z);
    const bool deep = stock_top - start.z > kShallow;
    double from = over;
    if (deep && entry_ == EntryKind::kHelix) {
        tip_.line(MoveKind::kPlunge, {start.x, start.y, over});
        const bool wound = helix(start, over, circle);
        narrow_entries_ += wound ? 0 : 1;
        // What the floor around keeps the helix from is left to a ramp.
        from = tip_.at().z;
        if (from - start.z <= kShallow) {
            tip_.line(MoveKind::kPlunge, start);
            return;
        }
    }
    if (deep && entry_ != EntryKind::kPlunge && plan_length(way) > radius_ / 4) {
        tip_.line(MoveKind::kPlunge, {start.x, start.y, from});
        ramp(way, from);
        return;
    }
    plunges_ += deep ? 1 : 0;
    tip_.line(MoveKind::kPlunge, start);
}

bool GridToolpathWriter::helix(Vec3d start, double from, const CircleFloor& circle)
{
    constexpr int kSides = 16;
    const double radius = kHelixShare * radius_;
    std::optional<double> lowest;
    Vec2d centre{};
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * kPi * i / kSides;
        const Vec2d c = in_plan(start) + Vec2d{std::cos(angle), std::sin(angle)} * radius;
        const std::optional<double> z = circle(c, radius);
        if (z && (!lowest || *z < *lowest)) {
            lowest = z;
            centre = c;
        }
    }
    const double end = std::max(start.z, lowest.value_or(from));
    if (from - end <= kShallow) {
        return false;
    }
    // Half turns, then a level turn that clears what the last slope left.
    const double depth = from - end;
    const double drop = std::min(2 * kPi * radius * kEntrySlope, most_drop_);
    const int halves = 2 * std::max(1, static_cast<int>(std::ceil(depth / drop)));
    const Vec2d opposite = centre * 2.0 - in_plan(start);
    for (int i = 1; i <= halves + 2; ++i) {
        const Vec2d p = i % 2 == 0 ? in_plan(start) : opposite;
        const double z = i < halves ? from - depth * i / halves : end;
        tip_.arc(MoveKind::kPlunge, {{p.x, p.y, z}, {centre.x, centre.y, z}, ArcPlane::kXY, false});
    }
    ++helices_;
    return true;
}

void GridToolpathWriter::ramp(const std::vector<Vec3d>& way, double from)
{
    const double depth = from - way.front().z;
    const double length = plan_length(way);
    const double drop = std::min(2 * length * kEntrySlope, most_drop_);
    const int trips = std::max(1, static_cast<int>(std::ceil(depth / drop)));
    const double whole = 2 * trips * length;
    double gone = 0;
    const auto go = [&](Vec3d p) {
        const Vec3d at = tip_.at();
        gone += std::hypot(p.x - at.x, p.y - at.y);
        const double lift = depth * std::max(0.0, 1 - gone / whole);
        tip_.line(MoveKind::kPlunge, {p.x, p.y, p.z + lift});
    };
    for (int trip = 0; trip < trips; ++trip) {
        std::for_each(way.begin() + 1, way.end(), go);
        std::for_each(way.rbegin() + 1, way.rend(), go);
    }
    tip_.line(MoveKind::kPlunge, way.front());
}

}  // namespace cusp::grid_pocket
