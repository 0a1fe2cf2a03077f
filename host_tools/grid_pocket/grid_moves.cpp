// A ramp is the run itself, lifted by an amount that falls with the way gone.
#include "host_tools/grid_pocket/grid_moves.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {
namespace {

constexpr double kAboveMetal = 1.0;     // mm: rapids go no nearer
constexpr double kEntrySlope = 0.0524;  // 3 degrees
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

void GridMoves::retract()
{
    if (tip_.started() && !lifted()) {
        const Vec3d at = tip_.at();
        tip_.line(MoveKind::kRapid, {at.x, at.y, clearance_z_});
        ++retracts_;
    }
}

void GridMoves::enter(const FloorFollower& floor, const std::vector<Vec2d>& corners, double metal)
{
    enter_level(floor.chords(corners, ramp_length()), metal, false);
}

void GridMoves::enter_level(const std::vector<Vec3d>& way, double metal, bool link)
{
    const Vec3d start = way.front();
    const double over = std::max(metal, start.z);
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
    const bool deep = metal - start.z > kShallow;
    if (deep && entry_ != EntryKind::kPlunge && plan_length(way) > radius_ / 4) {
        tip_.line(MoveKind::kPlunge, {start.x, start.y, over});
        ramp(way, over);
        return;
    }
    plunges_ += deep ? 1 : 0;
    tip_.line(MoveKind::kPlunge, start);
}

void GridMoves::ramp(const std::vector<Vec3d>& way, double from)
{
    const double depth = from - way.front().z;
    const double length = plan_length(way);
    const int trips = std::max(1, static_cast<int>(std::ceil(depth / (2 * length * kEntrySlope))));
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

}  // namespace cusp::host
