// Entries descend at a gentle slope; the pass removes the stock that the slope leaves.
#include "host_tools/cam/contour_pocket/cl_path_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::contour_pocket {

using cl_path::ClMove;
using cl_path::ClPath;
using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::EntryRun;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::NurbsTo;
using toolpath::plan_length;
using toolpath::RunPiece;
using toolpath::there_and_back;
using toolpath::ToolMove;

namespace {

constexpr double kAboveStock = 0.1;   // mm above the stock: the plunge feed ends
constexpr double kRapidOver = 0.9;    // mm above that: end of rapid moves
constexpr double kSettled = 0.03;     // mm above the pass: the slope has reached it
constexpr double kHardlyDeep = 0.15;  // mm of plunge: height that a helix leaves above the pass
constexpr double kSamePoint = 1e-6;   // mm in plan
constexpr int kHelixSides = 48;
constexpr int kMostPoints = 100000;  // of one entry: a limit where a pass is too short for a slope

double plan_distance(Vec3d a, Vec3d b) { return elementary::hypot(a.x - b.x, a.y - b.y); }

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

EntryRun run_of(const ClPath& path)
{
    EntryRun run{path.start, {}};
    for (const ClMove& move : path.moves) {
        run.pieces.push_back({move.end, move.centre, move.turn});
    }
    return run;
}

}  // namespace

void EntryHeights::raise_over(const EntryHeights& other)
{
    rapid = std::max(rapid, other.rapid);
    stock_top = std::max(stock_top, other.stock_top);
}

EntryHeights heights_over(double stock_top)
{
    return {stock_top + kAboveStock + kRapidOver, stock_top + kAboveStock};
}

std::vector<ToolMove> tool_moves(const ClPath& path, MoveKind kind)
{
    std::vector<ToolMove> moves;
    moves.reserve(path.moves.size());
    for (const ClMove& move : path.moves) {
        moves.push_back(tool_move(kind, move));
    }
    return moves;
}

bool ClPathWriter::is_over(Vec3d place) const
{
    return is_down() && plan_distance(writer_.at(), place) < kSamePoint;
}

// Moves above the start, as low as the stock allows. Returns that z.
double ClPathWriter::begin_entry(Vec3d start, const EntryHeights& heights)
{
    const double z = std::max(heights.stock_top, start.z);
    const Vec3d at = writer_.at();
    if (!is_over(start)) {
        writer_.approach(in_plan(start), heights.rapid);
        plunge({start.x, start.y, z});
        return z;
    }
    if (at.z > heights.rapid && at.z > z) {
        writer_.line(MoveKind::kRapid, {at.x, at.y, std::max(heights.rapid, z)});
    }
    const double lower = std::clamp(writer_.at().z, start.z, z);
    plunge({at.x, at.y, lower});
    return lower;
}

void ClPathWriter::enter_along(const ClPath& path,
                               const EntryHeights& heights,
                               double least_turn,
                               bool plunges)
{
    const bool vertical = is_over(path.start);
    double z = begin_entry(path.start, heights);
    EntryRun pass = run_of(path);
    const double way = (z - path.start.z) / kEntrySlope;
    const bool open = plan_distance(pass.start, pass.end()) > kSamePoint;
    const bool narrow = !open && kEntrySlope * plan_length(pass) < least_turn;
    if (open || (vertical && !narrow && way < plan_length(pass))) {
        pass = there_and_back(pass, way);
    }
    const double round = plan_length(pass);
    double lowest = pass.start.z;
    for (const RunPiece& piece : pass.pieces) {
        lowest = std::min(lowest, piece.end.z);
    }
    const double slope = narrow ? least_turn / std::max(round, 1e-9) : kEntrySlope;
    const double turns = (z - lowest) / std::max(slope * round, 1e-9);
    const bool steep = turns * static_cast<double>(pass.pieces.size()) > kMostPoints;
    if (plunges || steep) {
        steep_plunges_ += plunges || z - path.start.z < kHardlyDeep ? 0 : 1;
        plunge(path.start);
        return;
    }
    for (bool sloped = true; sloped && z > lowest;) {
        sloped = false;
        Vec3d from = pass.start;
        for (const RunPiece& piece : pass.pieces) {
            z -= slope * plan_length(from, piece);
            // Corners of the slope keep clear of the pass.
            const bool over = z > piece.end.z + kSettled;
            sloped = sloped || over;
            plunge_along(piece, over ? z : piece.end.z);
            from = piece.end;
        }
    }
}

void ClPathWriter::plunge_along(const RunPiece& piece, double z)
{
    const Vec3d end{piece.end.x, piece.end.y, z};
    if (piece.turn == 0) {
        plunge(end);
    } else {
        writer_.arc(MoveKind::kPlunge,
                    {end, {piece.centre.x, piece.centre.y, z}, ArcPlane::kXY, piece.turn < 0});
    }
}

// A straight move there, or a higher one if the floor is in the way.
void ClPathWriter::plunge_over(Vec3d end, const std::function<double(Vec3d, Vec3d)>& clearance)
{
    constexpr int kRounds = 12;
    const Vec3d from = writer_.at();
    double lift = 0.0;
    for (int round = 0; round < kRounds; ++round) {
        const Vec3d up{0.0, 0.0, lift};
        const double room = clearance(from + up, end + up);
        if (room >= 0.0) {
            break;
        }
        lift += 0.01 - 2.0 * room;
    }
    plunge(from + Vec3d{0.0, 0.0, lift});
    plunge(end + Vec3d{0.0, 0.0, lift});
}

double ClPathWriter::enter_by_helix(const Helix& helix, const HelixFloor& floor)
{
    // Stock that remains below the helix is removed on the way to the pass, or by the slope along
    // it.
    constexpr double kOver = 0.05;
    constexpr double kHelixRapidOver = 0.5;
    constexpr double kGentle = 0.1;
    const Vec3d centre = helix.centre;
    std::vector<Vec3d> sides;
    double highest = -kUnbounded;
    double deepest = kUnbounded;
    for (int i = 1; i <= kHelixSides; ++i) {
        const double angle = 2 * kPi * i / kHelixSides;
        const Vec2d at =
            in_plan(centre) + Vec2d{elementary::cos(angle), elementary::sin(angle)} * helix.radius;
        sides.push_back({at.x, at.y, std::max(floor.lowest(at) + kOver, centre.z)});
        highest = std::max(highest, sides.back().z);
        deepest = std::min(deepest, sides.back().z);
    }
    const double drop = kEntrySlope * helix.radius * 2 * kPi / kHelixSides;
    double z = std::max({helix.heights.stock_top, highest, centre.z});
    const Vec3d at = writer_.at();
    const Vec3d first{sides.back().x, sides.back().y, std::max(z, at.z)};
    if (is_over(centre)) {
        plunge({at.x, at.y, first.z});
        plunge_over(first, floor.clearance);
    } else {
        writer_.approach(in_plan(first), std::max(helix.heights.rapid, z + kHelixRapidOver));
        plunge({first.x, first.y, z});
    }
    if (helix.arcs && highest <= deepest) {
        half_turns(in_plan(centre), deepest, drop * kHelixSides / 2);
        z = deepest;
    }
    for (std::size_t i = 0; z > deepest; i = (i + 1) % sides.size()) {
        z -= drop;
        plunge_over({sides[i].x, sides[i].y, std::max(z, sides[i].z)}, floor.clearance);
    }
    const bool gentle = helix.whole || writer_.at().z - centre.z <= kGentle * helix.radius;
    plunge_over({centre.x, centre.y, gentle ? centre.z : writer_.at().z}, floor.clearance);
    return writer_.at().z;
}

// Around a level place, from where the tool is down to z.
//
// most  mm, of a half turn
void ClPathWriter::half_turns(Vec2d centre, double z, double most)
{
    const double depth = writer_.at().z - z;
    const int count = std::max(1, static_cast<int>(std::ceil(depth / most)));
    for (int i = 1; i <= count; ++i) {
        const Vec2d opposite = centre * 2.0 - in_plan(writer_.at());
        plunge_along({{opposite.x, opposite.y, 0.0}, centre, 1}, z + depth * (count - i) / count);
    }
}

void ClPathWriter::follow(MoveKind kind, const ClPath& path)
{
    const std::size_t before = moves_.size();
    writer_.line(kind, path.start);
    int spline_points = 0;
    for (const ClMove& move : path.moves) {
        if (move.turn == 0 && move.curve.points.empty()) {
            writer_.line(kind, move.end);
            continue;
        }
        writer_.add(tool_move(kind, move));
        // The first control point of a spline counts as the move itself.
        spline_points += std::max(0, static_cast<int>(move.curve.points.size()) - 2);
    }
    if (kind == MoveKind::kCut) {
        points_ += static_cast<int>(moves_.size() - before) + spline_points;
    }
}

}  // namespace cusp::contour_pocket
