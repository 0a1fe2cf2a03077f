// Entries slope down no steeper than a ball-end mill likes; what the slope leaves, the pass
// removes.
#include "host_tools/contour_pocket/pocket_moves.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

namespace {

constexpr double kSlope = 0.08;  // of ramps and helices: 4.6 degrees
constexpr double kAbove = 1.0;   // mm over metal where rapids end
constexpr int kHelixSides = 48;
constexpr double kOutOfStock = 0.1;  // mm over the stock where a slope starts
constexpr int kMostPoints = 200000;  // of one entry: where a pass is too short for a slope

double plan_distance(Vec3d a, Vec3d b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

void PocketMoves::line(MoveKind kind, Vec3d end)
{
    if (!moves_.empty() && end == at_) {
        return;
    }
    moves_.push_back({kind, LineTo{end}});
    at_ = end;
    points_ += kind == MoveKind::kCut ? 1 : 0;
}

void PocketMoves::approach(Vec3d start)
{
    line(MoveKind::kRapid, {start.x, start.y, heights_.clearance});
    const double near = std::max(heights_.top, start.z) + kAbove;
    if (near < heights_.clearance) {
        line(MoveKind::kRapid, {start.x, start.y, near});
    }
}

void PocketMoves::enter_along(const FloorPath& path, bool plunge)
{
    std::vector<Vec3d> pass{path.start};
    for (const FloorMove& move : path.moves) {
        pass.push_back(move.end);
    }
    approach(pass.front());
    const double lowest =
        std::min_element(pass.begin(), pass.end(), [](Vec3d a, Vec3d b) { return a.z < b.z; })->z;
    double round = 0.0;
    for (std::size_t i = 1; i < pass.size(); ++i) {
        round += plan_distance(pass[i - 1], pass[i]);
    }
    double z = std::max(heights_.top + kOutOfStock, pass.front().z);
    const double turns = (z - lowest) / std::max(kSlope * round, 1e-9);
    if (plunge || turns * static_cast<double>(pass.size()) > kMostPoints) {
        line(MoveKind::kPlunge, pass.front());
        return;
    }
    line(MoveKind::kPlunge, {pass.front().x, pass.front().y, z});
    while (true) {
        bool sloped = false;
        for (std::size_t i = 1; i < pass.size(); ++i) {
            z -= kSlope * plan_distance(pass[i - 1], pass[i]);
            sloped = sloped || z > pass[i].z;
            line(MoveKind::kPlunge, {pass[i].x, pass[i].y, std::max(z, pass[i].z)});
        }
        if (!sloped || z < lowest) {
            break;
        }
    }
}

void PocketMoves::enter_by_helix(Vec3d centre, double radius, const TipFloor& floor)
{
    approach({centre.x + radius, centre.y, centre.z});
    double z = std::max(heights_.top + kOutOfStock, centre.z);
    line(MoveKind::kPlunge, {centre.x + radius, centre.y, z});
    const double drop = kSlope * radius * 6.283185307179586 / kHelixSides;
    for (bool sloped = true; sloped;) {
        sloped = false;
        for (int i = 1; i <= kHelixSides; ++i) {
            const double angle = 6.283185307179586 * i / kHelixSides;
            const Vec2d at{centre.x + radius * std::cos(angle),
                           centre.y + radius * std::sin(angle)};
            z -= drop;
            // Between two sides of the helix the floor may rise: half a millimetre covers it, and
            // the pass removes it.
            const double low = floor.drop(at).height + 0.5;
            sloped = sloped || z > std::max(low, centre.z);
            line(MoveKind::kPlunge, {at.x, at.y, std::max({z, low, centre.z})});
        }
    }
    line(MoveKind::kPlunge, {centre.x, centre.y, at_.z});
    line(MoveKind::kPlunge, centre);
}

void PocketMoves::follow(MoveKind kind, const FloorPath& path)
{
    line(kind, path.start);
    for (const FloorMove& move : path.moves) {
        if (move.turn == 0) {
            line(kind, move.end);
            continue;
        }
        const Vec3d centre{move.centre.x, move.centre.y, 0.0};
        moves_.push_back({kind, ArcTo{move.end, centre, ArcPlane::kXY, move.turn < 0}});
        at_ = move.end;
        points_ += kind == MoveKind::kCut ? 1 : 0;
    }
}

void PocketMoves::retract()
{
    if (!moves_.empty() && at_.z < heights_.clearance) {
        line(MoveKind::kRapid, {at_.x, at_.y, heights_.clearance});
        ++retracts_;
    }
}

}  // namespace cusp::host
