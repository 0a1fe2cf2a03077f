// Looks the floor up along the path, takes the longest moves that stay in the band, certifies every
// move and lifts what would cut too deep.
#include "host_tools/contour_pocket/floor_path.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/contour_pocket/tolerance_chain.hpp"

namespace cusp::host {

namespace {

double to_step(double x) { return std::round(x / kWrittenStep) * kWrittenStep; }

Vec3d written(Vec3d p)
{
    return {to_step(p.x), to_step(p.y), std::ceil(p.z / kWrittenStep - 1e-6) * kWrittenStep};
}

std::vector<Vec2d> stations_in_plan(const std::vector<Edge>& plan,
                                    const FloorPathSettings& settings)
{
    std::vector<Vec2d> points{plan.front().start};
    for (const Edge& edge : plan) {
        double spacing = settings.spacing;
        if (edge.turn != 0) {
            // Chords of the arc keep within an eighth of what is allowed.
            spacing = std::min(spacing, std::sqrt(edge.radius * settings.aside));
        }
        const int n = std::max(1, static_cast<int>(std::ceil(length(edge) / spacing)));
        for (int i = 1; i <= n; ++i) {
            points.push_back(i == n ? edge.end : point_on(edge, static_cast<double>(i) / n));
        }
    }
    return points;
}

// Chords of a move, each with how far the move itself may lie from it.
struct Chords {
    std::vector<Vec3d> points;
    double sagitta;
};

Chords chords_of(Vec3d start, const FloorMove& move, double fine)
{
    if (move.turn == 0) {
        return {{start, move.end}, 0.0};
    }
    const Vec2d a = Vec2d{start.x, start.y} - move.centre;
    const Vec2d b = Vec2d{move.end.x, move.end.y} - move.centre;
    const double radius = std::sqrt(dot(a, a));
    const double angle = std::atan2(cross(a, b), dot(a, b));
    const double step = std::sqrt(8.0 * fine / radius);
    const int n = 1 + static_cast<int>(std::abs(angle) / step);
    Chords chords;
    for (int i = 0; i <= n; ++i) {
        const double t = angle * i / n;
        const Vec2d p = move.centre + a * std::cos(t) + left_normal(a) * std::sin(t);
        chords.points.push_back({p.x, p.y, start.z + (move.end.z - start.z) * i / n});
    }
    chords.sagitta = radius * (1.0 - std::cos(0.5 * angle / n));
    return chords;
}

double gap_of(Vec3d start, const FloorMove& move, const TipFloor& floor, double fine)
{
    const Chords chords = chords_of(start, move, fine);
    double least = 0.0;
    for (std::size_t i = 1; i < chords.points.size(); ++i) {
        least = std::min(least, floor.gap(chords.points[i - 1], chords.points[i], chords.sagitta));
    }
    return least;
}

// Raises both ends of every move by what it lacks to keep off the floor, until none lacks anything.
// Raising only ever adds room to the neighbours; a closed path's ends are raised together.
void certify(FloorPath& path, const TipFloor& floor, const FloorPathSettings& settings, bool closed)
{
    constexpr int kRounds = 8;
    path.least_gap = 0.0;
    // An arc's chords leave half of the cushion to the slope.
    const double fine = std::max(0.5 * settings.cushion, kWrittenStep);
    for (std::size_t i = 0; i < path.moves.size(); ++i) {
        Vec3d& start = i == 0 ? path.start : path.moves[i - 1].end;
        Vec3d& end = path.moves[i].end;
        double gap = gap_of(start, path.moves[i], floor, fine);
        for (int round = 0; settings.lift && gap < 0.0 && round < kRounds; ++round) {
            const double raise = kWrittenStep + 1.5 * -gap;
            start = written(start + Vec3d{0.0, 0.0, raise});
            end = written(end + Vec3d{0.0, 0.0, raise});
            gap = gap_of(start, path.moves[i], floor, fine);
        }
        path.least_gap = std::min(path.least_gap, gap);
    }
    if (closed && !path.moves.empty()) {
        const double top = std::max(path.start.z, path.moves.back().end.z);
        path.start.z = path.moves.back().end.z = top;
    }
}

}  // namespace

FloorPath lay_on_floor(const std::vector<Edge>& plan,
                       const TipFloor& floor,
                       const FloorPathSettings& settings)
{
    FloorPath path;
    std::vector<Station> stations;
    for (const Vec2d at : stations_in_plan(plan, settings)) {
        const TipFloor::Rest rest = floor.drop(at);
        if (rest.height == TipFloor::kNothing) {
            path.over_floor = false;
            path.missing = at;
            return path;
        }
        const double height = rest.height + settings.raise;
        const bool level = height < settings.level;
        stations.push_back({at, level ? settings.level : height, level ? Vec2d{} : rest.gradient});
    }
    const bool closed = distance(stations.front().at, stations.back().at) < 1e-9;
    // Between stations the floor may bend by a little more than at them, and an arc by an eighth.
    constexpr double kUsed = 0.95;
    constexpr double kUsedAside = 0.86;
    const double low = settings.lift ? settings.cushion : -kUsed * settings.above;
    const Chain chain = chain_through(stations, kUsedAside * settings.aside, low,
                                      kUsed * settings.above, settings.arcs, closed);
    path.start = written(chain.start);
    path.moves = chain.moves;
    for (FloorMove& move : path.moves) {
        move.end = written(move.end);
    }
    if (closed && !path.moves.empty()) {
        path.moves.back().end = path.start;
    }
    certify(path, floor, settings, closed);
    return path;
}

}  // namespace cusp::host
