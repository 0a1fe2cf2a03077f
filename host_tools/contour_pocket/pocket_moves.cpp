// Entries slope down no steeper than a ball-end mill likes; what the slope leaves, the pass
// removes.
#include "host_tools/contour_pocket/pocket_moves.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

namespace {

constexpr double kSlope = 0.08;    // of ramps and helices: 4.6 degrees
constexpr double kSettled = 0.03;  // mm over the pass: here the slope has met it
constexpr int kHelixSides = 48;
constexpr int kMostPoints = 100000;  // of one entry: where a pass is too short for a slope

double plan_distance(Vec3d a, Vec3d b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

ToolMove tool_move(MoveKind kind, const FloorMove& move)
{
    if (!move.curve.points.empty()) {
        return {kind, NurbsTo{move.curve}};
    }
    if (move.turn == 0) {
        return {kind, LineTo{move.end}};
    }
    const Vec3d centre{move.centre.x, move.centre.y, 0.0};
    return {kind, ArcTo{move.end, centre, ArcPlane::kXY, move.turn < 0}};
}

void PocketMoves::line(MoveKind kind, Vec3d end)
{
    if (!moves_.empty() && end == at_) {
        return;
    }
    moves_.push_back({kind, LineTo{end}});
    at_ = end;
    points_ += kind == MoveKind::kCut ? 1 : 0;
}

void PocketMoves::approach(Vec2d at, const EntryHeights& heights)
{
    retract();
    line(MoveKind::kRapid, {at.x, at.y, clearance_});
    if (heights.rapid < clearance_) {
        line(MoveKind::kRapid, {at.x, at.y, heights.rapid});
    }
    line(MoveKind::kPlunge, {at.x, at.y, heights.metal});
}

void PocketMoves::enter_along(const FloorPath& path, const EntryHeights& heights, bool plunge)
{
    std::vector<Vec3d> pass{path.start};
    double round = 0.0;
    double lowest = path.start.z;
    for (const FloorMove& move : path.moves) {
        round += plan_distance(pass.back(), move.end);
        lowest = std::min(lowest, move.end.z);
        pass.push_back(move.end);
    }
    double z = std::max(heights.metal, path.start.z);
    const bool stands_over = !moves_.empty() && plan_distance(at_, path.start) < 1e-6 &&
                             at_.z >= path.start.z && at_.z < heights.rapid;
    if (stands_over) {
        z = at_.z;
    } else {
        approach({path.start.x, path.start.y}, {heights.rapid, z});
    }
    const double turns = (z - lowest) / std::max(kSlope * round, 1e-9);
    if (plunge || turns * static_cast<double>(pass.size()) > kMostPoints) {
        line(MoveKind::kPlunge, pass.front());
        return;
    }
    for (bool sloped = true; sloped && z > lowest;) {
        sloped = false;
        for (std::size_t i = 1; i < pass.size(); ++i) {
            z -= kSlope * plan_distance(pass[i - 1], pass[i]);
            // No corner of the slope lies just over the pass.
            const bool over = z > pass[i].z + kSettled;
            sloped = sloped || over;
            line(MoveKind::kPlunge, {pass[i].x, pass[i].y, over ? z : pass[i].z});
        }
    }
}

// Straight there, higher where the floor between is in the way.
void PocketMoves::plunge_over(Vec3d end, const std::function<double(Vec3d, Vec3d)>& gap)
{
    constexpr int kRounds = 12;
    double lift = 0.0;
    for (int round = 0; round < kRounds; ++round) {
        const Vec3d up{0.0, 0.0, lift};
        const double room = gap(at_ + up, end + up);
        if (room >= 0.0) {
            break;
        }
        lift += 0.01 - 2.0 * room;
    }
    line(MoveKind::kPlunge, at_ + Vec3d{0.0, 0.0, lift});
    line(MoveKind::kPlunge, end + Vec3d{0.0, 0.0, lift});
}

void PocketMoves::enter_by_helix(Vec3d centre,
                                 double radius,
                                 const EntryHeights& heights,
                                 const std::function<double(Vec2d)>& lowest,
                                 const std::function<double(Vec3d, Vec3d)>& gap)
{
    // What stays under the helix is removed by the pass.
    constexpr double kOver = 0.5;
    std::vector<Vec3d> sides;
    double highest = centre.z;
    for (int i = 1; i <= kHelixSides; ++i) {
        const double angle = 6.283185307179586 * i / kHelixSides;
        const Vec2d at{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
        sides.push_back({at.x, at.y, std::max(lowest(at) + kOver, centre.z)});
        highest = std::max(highest, sides.back().z);
    }
    const double drop = kSlope * radius * 6.283185307179586 / kHelixSides;
    double z = std::max(heights.metal, highest);
    approach({sides.back().x, sides.back().y}, {std::max(heights.rapid, z + kOver), z});
    for (bool sloped = true; sloped;) {
        sloped = false;
        for (const Vec3d side : sides) {
            z -= drop;
            sloped = sloped || z > side.z;
            plunge_over({side.x, side.y, std::max(z, side.z)}, gap);
        }
    }
    plunge_over({centre.x, centre.y, at_.z}, gap);
    line(MoveKind::kPlunge, centre);
}

void PocketMoves::follow(MoveKind kind, const FloorPath& path)
{
    line(kind, path.start);
    for (const FloorMove& move : path.moves) {
        if (move.turn == 0 && move.curve.points.empty()) {
            line(kind, move.end);
            continue;
        }
        moves_.push_back(tool_move(kind, move));
        at_ = move.end;
        const int points = std::max(1, static_cast<int>(move.curve.points.size()) - 1);
        points_ += kind == MoveKind::kCut ? points : 0;
    }
}

void PocketMoves::retract()
{
    if (!moves_.empty() && at_.z < clearance_) {
        line(MoveKind::kRapid, {at_.x, at_.y, clearance_});
        ++retracts_;
    }
}

}  // namespace cusp::host
