// A move that gouges is raised by its shortfall of clearance. It is halved first if only a part of
// it has a large shortfall.
#include "host_tools/cam/cl_path/cl_path_proof.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::cl_path {

using nurbs::Curve;
using offset::left_normal;
using offset::unit;

Vec3d written(Vec3d p)
{
    const auto to_step = [](double x) {
        return std::round(x / kWrittenStep) * kWrittenStep;
    };
    return {to_step(p.x), to_step(p.y), std::ceil(p.z / kWrittenStep - 1e-6) * kWrittenStep};
}

namespace {

// Chords of a move, each with the largest distance of the move from it.
struct Chords {
    std::vector<Vec3d> points;
    double sagitta;
    std::vector<std::size_t> spans{};  // of a curve: the knot before the chord to each point
};

// The second derivative of a cubic is linear between knots, so its largest value is at a knot.
Chords chords_of(const Curve& curve, double fine)
{
    Chords chords{{point_at(curve, curve.domain_begin())}, fine, {0}};
    for (std::size_t k = 3; k < curve.points.size(); ++k) {
        const double u = curve.knots[k];
        const double width = curve.knots[k + 1] - u;
        if (width <= 0.0) {
            continue;
        }
        const double inside = 1e-9 * width;
        const double bend = std::max(norm(derivatives_at(curve, u + inside).second),
                                     norm(derivatives_at(curve, u + width - inside).second));
        const int n = 1 + static_cast<int>(width * std::sqrt(bend / (8.0 * fine)));
        for (int i = 1; i <= n; ++i) {
            chords.points.push_back(point_at(curve, u + width * i / n));
            chords.spans.push_back(k);
        }
    }
    return chords;
}

Chords chords_of(Vec3d start, const ClMove& move, double fine)
{
    if (!move.curve.points.empty()) {
        return chords_of(move.curve, fine);
    }
    if (move.turn == 0) {
        return {{start, move.end}, 0.0};
    }
    const Vec2d a = in_plan(start) - move.centre;
    const Vec2d b = in_plan(move.end) - move.centre;
    const double radius = std::sqrt(dot(a, a));
    const double angle = elementary::atan2(cross(a, b), dot(a, b));
    const double step = std::sqrt(8.0 * fine / radius);
    const int n = 1 + static_cast<int>(std::abs(angle) / step);
    Chords chords;
    for (int i = 0; i <= n; ++i) {
        const double t = angle * i / n;
        const Vec2d p = move.centre + a * elementary::cos(t) + left_normal(a) * elementary::sin(t);
        chords.points.push_back({p.x, p.y, start.z + (move.end.z - start.z) * i / n});
    }
    chords.sagitta = radius * (1.0 - elementary::cos(0.5 * angle / n));
    return chords;
}

double clearance_of(Vec3d start, const ClMove& move, const PathFloor& floor, double fine)
{
    if (move.turn == 0 && move.curve.points.empty()) {
        return floor.move_clearance(start, move.end);
    }
    const Chords chords = chords_of(start, move, fine);
    double least = 0.0;
    for (std::size_t i = 1; i < chords.points.size(); ++i) {
        least = std::min(
            least, floor.move_clearance(chords.points[i - 1], chords.points[i], chords.sagitta));
    }
    return least;
}

// A move with a shortfall of more than `bands` touches a cliff. It is halved down to `shortest` of
// the tool's radius, so that only the part at the cliff is raised.
struct Graze {
    double bands;
    double shortest;
};
constexpr Graze kGrazes[] = {{10.0, 0.02}, {1.0, 0.1}};

// Lower limit of the clearance of moves, mm, <= 0.
double allowed_clearance(const ClPathSettings& settings)
{
    return settings.one_sided ? 0.0
                              : -(settings.height_tolerance + 2.0 * settings.clearance_reserve);
}

// Beside a cliff a move must not start to climb before its end, nor descend before its start is
// passed. Raising a steep move does not help.
bool is_steep(Vec3d start, const ClMove& move)
{
    const double along = elementary::hypot(move.end.x - start.x, move.end.y - start.y);
    const double rise = std::abs(move.end.z - start.z);
    return move.turn == 0 && move.curve.points.empty() && along > 0.0 &&
           rise > 2.0 * along + 10.0 * kWrittenStep;
}

// The corner that replaces a steep move by a horizontal move at its higher end and a vertical move.
Vec3d corner_of_steep_move(Vec3d start, Vec3d end)
{
    return start.z > end.z ? Vec3d{end.x, end.y, start.z} : Vec3d{start.x, start.y, end.z};
}

// The first half of a move, in plan and in height.
ClMove first_half(Vec3d start, const ClMove& move)
{
    ClMove half = move;
    half.end = written((start + move.end) * 0.5);
    if (move.turn != 0) {
        const Vec2d a = in_plan(start) - move.centre;
        const Vec2d b = in_plan(move.end) - move.centre;
        const double radius = std::sqrt(dot(a, a));
        const double turn = 0.5 * elementary::atan2(cross(a, b), dot(a, b));
        const Vec2d p =
            move.centre +
            unit(a * elementary::cos(turn) + left_normal(a) * elementary::sin(turn)) * radius;
        half.end = written({p.x, p.y, half.end.z});
    }
    return half;
}

// Moves up to this length (mm) are raised as a whole by their shortfall (mm). Steep ones are
// replaced by horizontal and vertical moves instead: the shorter, the closer to the original.
double shortest_halved(double radius, double lacks, bool steep, const ClPathSettings& settings)
{
    for (const Graze& graze : kGrazes) {
        if (lacks > graze.bands * settings.height_tolerance) {
            return (steep ? kGrazes[0].shortest : graze.shortest) * radius;
        }
    }
    return kUnbounded;
}

void halve_move(std::vector<ClMove>& moves, std::size_t i, Vec3d start)
{
    const ClMove half = first_half(start, moves[i]);
    moves.insert(moves.begin() + static_cast<std::ptrdiff_t>(i), half);
}

// z of a move's ends at which it clears the floor, and its clearance there.
struct Raised {
    double start, end;
    double clearance;
};

Raised raised_off(
    Vec3d start, ClMove move, double clearance, const PathFloor& floor, double allowed, double fine)
{
    constexpr int kRounds = 20;
    constexpr int kGentleRounds = 4;  // then larger steps
    for (int round = 0; clearance < allowed && round < kRounds; ++round) {
        const double factor = std::ldexp(1.0, std::max(0, round - kGentleRounds));
        const Vec3d raise{0.0, 0.0, factor * (kWrittenStep + 1.5 * (allowed - clearance))};
        start = written(start + raise);
        move.end = written(move.end + raise);
        clearance = clearance_of(start, move, floor, fine);
    }
    return {start.z, move.end.z, clearance};
}

// Inserts vertical moves before and after the raised move i, so that its neighbours stay unchanged.
void add_vertical_moves(std::vector<ClMove>& moves, std::size_t i, const Raised& raised)
{
    ClMove up{moves[i - 1].end};
    up.end.z = raised.start;
    const ClMove down{moves[i].end};
    moves[i].end.z = raised.end;
    const auto at = moves.begin() + static_cast<std::ptrdiff_t>(i);
    moves.insert(moves.insert(at + 1, down) - 1, up);
}

// True if a move is too long to be raised at one end beside a cliff: it would climb over its whole
// length.
bool is_long(Vec3d start, const ClMove& move, double radius)
{
    return move.curve.points.empty() &&
           elementary::hypot(move.end.x - start.x, move.end.y - start.y) >
               kGrazes[0].shortest * radius;
}

// Halves the moves before and after the move i until its neighbours are short. Returns by how many
// positions the index of move i has grown.
std::size_t halve_neighbours(ClPath& path, std::size_t i, double radius)
{
    std::vector<ClMove>& moves = path.moves;
    const auto begin_of = [&](std::size_t k) {
        return k == 0 ? path.start : moves[k - 1].end;
    };
    std::size_t before = 0;
    for (; i > 0 && is_long(begin_of(i - 1), moves[i - 1], radius); ++i, ++before) {
        halve_move(moves, i - 1, begin_of(i - 1));
    }
    while (i + 1 < moves.size() && is_long(moves[i].end, moves[i + 1], radius)) {
        halve_move(moves, i + 1, moves[i].end);
    }
    return before;
}

}  // namespace

// Raising never reduces the clearance of neighbours. The two ends of a closed path are raised
// together.
double certify(ClPath& path, const PathFloor& floor, const ClPathSettings& settings, bool closed)
{
    const double allowed = allowed_clearance(settings);
    path.least_clearance = 0.0;
    double highest_lift = 0.0;
    // The chords of an arc use half of the clearance reserve; the slope has the rest.
    const double fine = std::max(0.5 * settings.clearance_reserve, kWrittenStep);
    for (std::size_t i = 0; i < path.moves.size(); ++i) {
        Vec3d& start = i == 0 ? path.start : path.moves[i - 1].end;
        Vec3d& end = path.moves[i].end;
        const double clearance = clearance_of(start, path.moves[i], floor, fine);
        if (clearance >= allowed) {
            path.least_clearance = std::min(path.least_clearance, clearance);
            continue;
        }
        const double along = elementary::hypot(end.x - start.x, end.y - start.y);
        const Raised raised = raised_off(start, path.moves[i], clearance, floor, allowed, fine);
        const double lift = raised.end - end.z;
        const bool steep = is_steep(start, path.moves[i]);
        const double lacks = std::max(lift, allowed - clearance);
        if (path.moves[i].curve.points.empty() &&
            along > shortest_halved(floor.tool().radius, lacks, steep, settings)) {
            halve_move(path.moves, i, start);
            --i;
            continue;
        }
        if (steep && lift > settings.height_tolerance) {
            const ClMove corner{corner_of_steep_move(start, end)};
            path.moves.insert(path.moves.begin() + static_cast<std::ptrdiff_t>(i), corner);
            --i;
            continue;
        }
        path.least_clearance = std::min(path.least_clearance, raised.clearance);
        highest_lift = std::max(highest_lift, lift);
        if (lift > settings.height_tolerance && i > 0 && along > kWrittenStep) {
            add_vertical_moves(path.moves, i, raised);
            ++i;
        } else {
            const std::size_t before = lift > settings.height_tolerance
                                           ? halve_neighbours(path, i, floor.tool().radius)
                                           : 0;
            i += before;
            (i == 0 ? path.start : path.moves[i - 1].end).z = raised.start;
            path.moves[i].end.z = raised.end;
            // The halves are rounded, so they are certified again.
            i -= before > 0 ? before + 2 : 0;
        }
    }
    if (closed && !path.moves.empty()) {
        const double top = std::max(path.start.z, path.moves.back().end.z);
        path.start.z = path.moves.back().end.z = top;
    }
    return highest_lift;
}

namespace {

// Shortfall of clearance at the control points of a move (its ends if it is straight).
//
// allowed  mm: required clearance
// least    mm: the least clearance found is stored here
// max_shortfall  mm: at a larger one the remaining chords are skipped
std::vector<double> shortfalls(Vec3d start,
                               const ClMove& move,
                               const PathFloor& floor,
                               double fine,
                               double allowed,
                               double max_shortfall,
                               double& least)
{
    const auto raise = [&](double clearance) {
        least = std::min(least, clearance);
        return clearance < allowed ? kWrittenStep + 1.5 * (allowed - clearance) : 0.0;
    };
    if (move.curve.points.empty()) {
        return std::vector<double>(2, raise(clearance_of(start, move, floor, fine)));
    }
    std::vector<double> raises(move.curve.points.size(), 0.0);
    const Chords chords = chords_of(move.curve, fine);
    for (std::size_t i = 1; i < chords.points.size() && allowed - least <= max_shortfall; ++i) {
        const double raise_by =
            raise(floor.move_clearance(chords.points[i - 1], chords.points[i], chords.sagitta));
        // The four control points of the chord's span determine it.
        for (std::size_t k = chords.spans[i] - 3; k <= chords.spans[i]; ++k) {
            raises[k] = std::max(raises[k], raise_by);
        }
    }
    return raises;
}

Vec3d raised(Vec3d p, double by) { return by > 0.0 ? written(p + Vec3d{0.0, 0.0, by}) : p; }

// Neighbouring moves share their ends, and therefore the larger of two raises.
void raise_moves(ClPath& path, std::vector<std::vector<double>>& raises, bool closed)
{
    const std::size_t n = path.moves.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (i + 1 < n || closed) {
            std::vector<double>& next = raises[(i + 1) % n];
            raises[i].back() = next.front() = std::max(raises[i].back(), next.front());
        }
    }
    path.start = raised(path.start, raises.front().front());
    for (std::size_t i = 0; i < n; ++i) {
        path.moves[i].end = raised(path.moves[i].end, raises[i].back());
        std::vector<Vec3d>& points = path.moves[i].curve.points;
        for (std::size_t k = 0; k < points.size(); ++k) {
            points[k] = raised(points[k], raises[i][k]);
        }
    }
}

}  // namespace

// Raising a control point lowers no part of the curve: clear parts stay clear.
double certify_curves(ClPath& path,
                      const PathFloor& floor,
                      const ClPathSettings& settings,
                      bool closed)
{
    constexpr int kRounds = 20;
    const double allowed = allowed_clearance(settings);
    const double fine = std::max(0.5 * settings.clearance_reserve, kWrittenStep);
    double lift = 0.0;
    for (int round = 0; round < kRounds && !path.moves.empty(); ++round) {
        path.least_clearance = 0.0;
        std::vector<std::vector<double>> raises;
        Vec3d start = path.start;
        for (const ClMove& move : path.moves) {
            raises.push_back(shortfalls(start, move, floor, fine, allowed,
                                        settings.height_tolerance, path.least_clearance));
            start = move.end;
            if (allowed - path.least_clearance > settings.height_tolerance) {
                return allowed - path.least_clearance;
            }
        }
        const double lacks = allowed - path.least_clearance;
        if (lacks <= 0.0) {
            break;
        }
        raise_moves(path, raises, closed);
        lift += kWrittenStep + 1.5 * lacks;
    }
    return lift;
}

}  // namespace cusp::cl_path
