// Entries slope down no steeper than a ball-end mill likes; what the slope leaves, the pass
// removes.
#include "host_tools/contour_pocket/pocket_toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::contour_pocket {

using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::NurbsTo;
using toolpath::ToolMove;

namespace {

constexpr double kOverMetal = 0.1;    // mm: where the plunge feed hands over to a slope
constexpr double kRapidOver = 0.9;    // mm over that: where rapid moves end
constexpr double kSettled = 0.03;     // mm over the pass: here the slope has met it
constexpr double kHardlyDeep = 0.15;  // mm straight down: what a helix leaves over the pass
constexpr int kHelixSides = 48;
constexpr int kMostPoints = 100000;  // of one entry: where a pass is too short for a slope

double plan_distance(Vec3d a, Vec3d b) { return std::hypot(a.x - b.x, a.y - b.y); }

double plan_length(const std::vector<Vec3d>& pass)
{
    double sum = 0.0;
    for (std::size_t i = 1; i < pass.size(); ++i) {
        sum += plan_distance(pass[i - 1], pass[i]);
    }
    return sum;
}

// The beginning of a pass, as long in plan as half of `way`, and back to its start.
std::vector<Vec3d> to_and_fro(const std::vector<Vec3d>& pass, double way)
{
    std::vector<Vec3d> round{pass.front()};
    double left = 0.5 * way;
    for (std::size_t i = 1; i < pass.size() && left > 0.0; ++i) {
        const double step = plan_distance(pass[i - 1], pass[i]);
        const double share = step > left ? left / step : 1.0;
        round.push_back(pass[i - 1] + (pass[i] - pass[i - 1]) * share);
        left -= step;
    }
    for (std::size_t i = round.size() - 1; i-- > 0;) {
        round.push_back(round[i]);
    }
    return round;
}

}  // namespace

void EntryHeights::raise_over(const EntryHeights& other)
{
    rapid = std::max(rapid, other.rapid);
    stock_top = std::max(stock_top, other.stock_top);
}

EntryHeights heights_over(double stock_top)
{
    return {stock_top + kOverMetal + kRapidOver, stock_top + kOverMetal};
}

ToolMove tool_move(MoveKind kind, const ClMove& move)
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

void PocketToolpathWriter::line(MoveKind kind, Vec3d end)
{
    if (!moves_.empty() && end == at_) {
        return;
    }
    moves_.push_back({kind, LineTo{end}});
    at_ = end;
    points_ += kind == MoveKind::kCut ? 1 : 0;
}

void PocketToolpathWriter::approach(Vec2d at, const EntryHeights& heights)
{
    retract();
    line(MoveKind::kRapid, {at.x, at.y, clearance_});
    if (heights.rapid < clearance_) {
        line(MoveKind::kRapid, {at.x, at.y, heights.rapid});
    }
    line(MoveKind::kPlunge, {at.x, at.y, heights.stock_top});
}

bool PocketToolpathWriter::is_over(Vec3d place) const
{
    return is_down() && plan_distance(at_, place) < 1e-6;
}

void PocketToolpathWriter::enter_along(const ClPath& path, const EntryHeights& heights, bool plunge)
{
    double z = std::max(heights.stock_top, path.start.z);
    const bool stands = is_over(path.start);
    if (stands) {
        if (at_.z > heights.rapid && at_.z > z) {
            line(MoveKind::kRapid, {at_.x, at_.y, std::max(heights.rapid, z)});
        }
        z = std::clamp(at_.z, path.start.z, z);
        line(MoveKind::kPlunge, {at_.x, at_.y, z});
    } else {
        approach({path.start.x, path.start.y}, {heights.rapid, z});
    }
    std::vector<Vec3d> pass{path.start};
    for (const ClMove& move : path.moves) {
        pass.push_back(move.end);
    }
    const double way = (z - path.start.z) / kEntrySlope;
    const bool open = plan_distance(pass.front(), pass.back()) > 1e-6;
    if (open || (stands && way < plan_length(pass))) {
        pass = to_and_fro(pass, way);
    }
    const double round = plan_length(pass);
    const double lowest =
        std::min_element(pass.begin(), pass.end(), [](Vec3d a, Vec3d b) { return a.z < b.z; })->z;
    const double turns = (z - lowest) / std::max(kEntrySlope * round, 1e-9);
    const bool steep = turns * static_cast<double>(pass.size()) > kMostPoints;
    if (plunge || steep) {
        steep_plunges_ += plunge || z - path.start.z < kHardlyDeep ? 0 : 1;
        line(MoveKind::kPlunge, path.start);
        return;
    }
    for (bool sloped = true; sloped && z > lowest;) {
        sloped = false;
        for (std::size_t i = 1; i < pass.size(); ++i) {
            z -= kEntrySlope * plan_distance(pass[i - 1], pass[i]);
            // No corner of the slope lies just over the pass.
            const bool over = z > pass[i].z + kSettled;
            sloped = sloped || over;
            line(MoveKind::kPlunge, {pass[i].x, pass[i].y, over ? z : pass[i].z});
        }
    }
}

// Straight there, higher where the floor between is in the way.
void PocketToolpathWriter::plunge_over(Vec3d end,
                                       const std::function<double(Vec3d, Vec3d)>& clearance)
{
    constexpr int kRounds = 12;
    double lift = 0.0;
    for (int round = 0; round < kRounds; ++round) {
        const Vec3d up{0.0, 0.0, lift};
        const double room = clearance(at_ + up, end + up);
        if (room >= 0.0) {
            break;
        }
        lift += 0.01 - 2.0 * room;
    }
    line(MoveKind::kPlunge, at_ + Vec3d{0.0, 0.0, lift});
    line(MoveKind::kPlunge, end + Vec3d{0.0, 0.0, lift});
}

double PocketToolpathWriter::enter_by_helix(Vec3d centre,
                                            double radius,
                                            bool whole,
                                            const EntryHeights& heights,
                                            const std::function<double(Vec2d)>& lowest,
                                            const std::function<double(Vec3d, Vec3d)>& clearance)
{
    // What stays under the helix is removed on the way to the pass, or on the slope along it.
    constexpr double kOver = 0.05;
    constexpr double kRapidOver = 0.5;
    constexpr double kGentle = 0.1;
    std::vector<Vec3d> sides;
    double highest = centre.z;
    double deepest = 1e300;
    for (int i = 1; i <= kHelixSides; ++i) {
        const double angle = 2 * kPi * i / kHelixSides;
        const Vec2d at{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
        sides.push_back({at.x, at.y, std::max(lowest(at) + kOver, centre.z)});
        highest = std::max(highest, sides.back().z);
        deepest = std::min(deepest, sides.back().z);
    }
    const double drop = kEntrySlope * radius * 2 * kPi / kHelixSides;
    double z = std::max(heights.stock_top, highest);
    const Vec3d first{sides.back().x, sides.back().y, std::max(z, at_.z)};
    if (is_over(centre)) {
        line(MoveKind::kPlunge, {at_.x, at_.y, first.z});
        plunge_over(first, clearance);
    } else {
        approach({first.x, first.y}, {std::max(heights.rapid, z + kRapidOver), z});
    }
    for (std::size_t i = 0; z > deepest; i = (i + 1) % sides.size()) {
        z -= drop;
        plunge_over({sides[i].x, sides[i].y, std::max(z, sides[i].z)}, clearance);
    }
    const bool gentle = whole || at_.z - centre.z <= kGentle * radius;
    plunge_over({centre.x, centre.y, gentle ? centre.z : at_.z}, clearance);
    return at_.z;
}

void PocketToolpathWriter::follow(MoveKind kind, const ClPath& path)
{
    line(kind, path.start);
    for (const ClMove& move : path.moves) {
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

void PocketToolpathWriter::retract()
{
    if (!moves_.empty() && at_.z < clearance_) {
        line(MoveKind::kRapid, {at_.x, at_.y, clearance_});
        ++retracts_;
    }
}

}  // namespace cusp::contour_pocket
