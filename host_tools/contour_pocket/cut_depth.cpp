// Feels every move in turn; looks along paths before they are cut.
#include "host_tools/contour_pocket/cut_depth.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/contour_pocket/pocket_moves.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::host {

namespace {

// The metal is known at places only: what stands between them may be this much higher.
constexpr double kBetween = 0.005;   // mm
constexpr double kAimed = 0.9;       // of the depth allowed: what levels take
constexpr double kPitch = 1.0 / 24;  // of the finest tool's radius
constexpr double kChord = 0.002;     // mm: curves are felt along chords this near
constexpr double kApart = 1.0 / 20;  // of the tool's radius

}  // namespace

CutDepth::CutDepth(const Box2d& box, const Tool& finest, double top, double most)
    : metal_{box, finest, top, kPitch}, ahead_{metal_}, most_{most}
{
    begin(finest);
}

void CutDepth::begin(const Tool& tool)
{
    metal_.use(tool);
    apart_ = kApart * tool.radius;
    felt_ = 0;
}

void CutDepth::feel(const std::vector<ToolMove>& path)
{
    for (; felt_ < path.size(); ++felt_) {
        for (const Vec3d p : points_of(path[felt_], at_, kChord)) {
            // Where the first move of a path comes from is over the stock.
            deepest_ = felt_ > 0 ? std::max(deepest_, metal_.cut(at_, p)) : deepest_;
            at_ = p;
        }
    }
}

// Calls visit(from, to) with places of the path, no farther apart than `apart_`.
template <class Visit>
void CutDepth::walk(const FloorPath& path, Visit visit) const
{
    Vec3d at = path.start;
    visit(at, at);
    for (const FloorMove& move : path.moves) {
        for (const Vec3d p : points_of(tool_move(MoveKind::kCut, move), at, kChord)) {
            const int n = 1 + static_cast<int>(norm(p - at) / apart_);
            Vec3d from = at;
            for (int i = 1; i <= n; ++i) {
                const Vec3d to = at + (p - at) * (static_cast<double>(i) / n);
                visit(from, to);
                from = to;
            }
            at = p;
        }
    }
}

std::optional<double> CutDepth::level_over(const FloorPath& path, double share)
{
    if (most_ == kUnlimitedDepth) {
        return std::nullopt;
    }
    const double most = share * most_;
    double level = -1e300;
    ahead_ = metal_;
    walk(path, [&](Vec3d from, Vec3d to) {
        const double depth = ahead_.cut_inside(from, to) + kBetween;
        if (depth > most) {
            level = std::max(level, to.z + depth - kAimed * most);
        }
    });
    return level > -1e299 ? std::optional{level} : std::nullopt;
}

double CutDepth::highest(const FloorPath& path) const
{
    double z = -1e300;
    walk(path, [&](Vec3d, Vec3d to) { z = std::max(z, highest_at({to.x, to.y})); });
    return z;
}

double CutDepth::highest_at(Vec2d place) const { return metal_.touch(place) + kBetween; }

double CutDepth::highest_around(Vec2d centre, double radius) const
{
    constexpr int kPlaces = 32;
    double z = -1e300;
    for (int i = 0; i < kPlaces; ++i) {
        const double angle = 2 * kPi * i / kPlaces;
        z = std::max(z, highest_at(centre + Vec2d{std::cos(angle), std::sin(angle)} * radius));
    }
    return z;
}

}  // namespace cusp::host
