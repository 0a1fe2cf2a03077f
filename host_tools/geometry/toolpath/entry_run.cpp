// Arcs by their angles.
#include "host_tools/geometry/toolpath/entry_run.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::toolpath {

namespace {

// Radians, of an arc in its direction; > 0.
double sweep_of(Vec2d from, const RunPiece& arc)
{
    constexpr double kSamePlace = 1e-12;  // radians
    const Vec2d a = from - arc.centre;
    const Vec2d b = in_plan(arc.end) - arc.centre;
    const double sweep = arc.turn * elementary::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    return sweep > kSamePlace ? sweep : sweep + 2 * kPi;
}

// The piece up to a share of it.
RunPiece part_of(Vec3d from, const RunPiece& piece, double share)
{
    RunPiece part = piece;
    part.end = from + (piece.end - from) * share;
    if (piece.turn != 0) {
        const double angle = piece.turn * sweep_of(in_plan(from), piece) * share;
        const Vec2d a = in_plan(from) - piece.centre;
        part.end.x = piece.centre.x + a.x * elementary::cos(angle) - a.y * elementary::sin(angle);
        part.end.y = piece.centre.y + a.x * elementary::sin(angle) + a.y * elementary::cos(angle);
    }
    return part;
}

}  // namespace

EntryRun run_along(const std::vector<Vec3d>& points)
{
    EntryRun run{points.front(), {}};
    for (std::size_t i = 1; i < points.size(); ++i) {
        run.pieces.push_back({points[i]});
    }
    return run;
}

double plan_length(Vec3d from, const RunPiece& piece)
{
    if (piece.turn == 0) {
        return norm(in_plan(piece.end) - in_plan(from));
    }
    return norm(in_plan(from) - piece.centre) * sweep_of(in_plan(from), piece);
}

double plan_length(const EntryRun& run)
{
    double sum = 0;
    Vec3d at = run.start;
    for (const RunPiece& piece : run.pieces) {
        sum += plan_length(at, piece);
        at = piece.end;
    }
    return sum;
}

EntryRun beginning(const EntryRun& run, double length)
{
    EntryRun out{run.start, {}};
    double left = length;
    for (const RunPiece& piece : run.pieces) {
        if (!(left > 0)) {
            break;
        }
        const double size = plan_length(out.end(), piece);
        out.pieces.push_back(size > left ? part_of(out.end(), piece, left / size) : piece);
        left -= size;
    }
    return out;
}

EntryRun reversed(const EntryRun& run)
{
    EntryRun out{run.end(), {}};
    for (std::size_t i = run.pieces.size(); i-- > 0;) {
        const RunPiece& piece = run.pieces[i];
        const Vec3d begin = i == 0 ? run.start : run.pieces[i - 1].end;
        out.pieces.push_back({begin, piece.centre, -piece.turn});
    }
    return out;
}

EntryRun there_and_back(const EntryRun& run, double way)
{
    EntryRun round = beginning(run, 0.5 * way);
    const EntryRun back = reversed(round);
    round.pieces.insert(round.pieces.end(), back.pieces.begin(), back.pieces.end());
    return round;
}

}  // namespace cusp::toolpath
