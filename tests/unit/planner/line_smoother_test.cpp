// Short lines of a curve become pieces that keep to every vertex and every middle, and meet with the
// same direction and curvature.
#include "firmware/planner/line_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/planner/block.hpp"

using namespace cusp;
using planner::LineSmoother;

namespace {

constexpr float kTolerance = 0.01F;
constexpr float kDeparture = 0.008F;  // mm, that pieces may leave the lines by

path::Move line(Position start, Position end)
{
    path::Move move;
    move.start = start;
    move.end = end;
    move.feed = 50;
    move.tolerance = kTolerance;
    return move;
}

std::vector<path::Move> smoothed(const std::vector<Position>& vertices)
{
    LineSmoother smoother;
    std::vector<path::Move> pieces;
    path::Move piece;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const path::Move next = line(vertices[i - 1], vertices[i]);
        CHECK(LineSmoother::accepts(next));
        CHECK(smoother.continues(next));
        while (smoother.full()) {
            CHECK(smoother.next(LineSmoother::Patience::kFull, piece));
            pieces.push_back(piece);
        }
        smoother.add(next, kDeparture);
    }
    while (smoother.next(LineSmoother::Patience::kNone, piece)) {
        pieces.push_back(piece);
    }
    return pieces;
}

AxisVecd point_of(const path::Move& move, double t)
{
    const AxisVecd start = to_millimetres(move.start);
    const AxisVecd chord = to_millimetres(move.end) - start;
    if (const auto* quintic = std::get_if<path::Quintic>(&move.path)) {
        AxisVecd bulge{};
        for (unsigned i = 4; i-- > 0;) {
            const AxisVecf q = quintic->bulge[i];
            bulge = bulge * t + AxisVecd{q.x, q.y, q.z};
        }
        return start + chord * t + bulge * (t * (1 - t));
    }
    return start + chord * t;
}

planner::EndGeometry geometry_at(const path::Move& move, bool at_end)
{
    planner::Block block;
    const Position nm = move.end - move.start;
    block.displacement = {static_cast<std::int32_t>(16 * nm.x),
                          static_cast<std::int32_t>(16 * nm.y),
                          static_cast<std::int32_t>(16 * nm.z)};
    const auto& quintic = std::get<path::Quintic>(move.path);
    block.shape = planner::BlockShape::kQuintic;
    block.quintic.bulge = quintic.bulge;
    planner::set_length(block,
                        static_cast<std::uint32_t>(quintic.length * kPathUnitsPerMillimetre));
    return at_end ? planner::end_geometry(block) : planner::start_geometry(block);
}

struct Chord {
    AxisVecd start;
    AxisVecd along;
};

std::vector<Chord> chords_of(const std::vector<path::Move>& pieces)
{
    constexpr int kSteps = 200;
    std::vector<Chord> chords;
    for (const path::Move& piece : pieces) {
        AxisVecd before = point_of(piece, 0);
        for (int i = 1; i <= kSteps; ++i) {
            const AxisVecd here = point_of(piece, static_cast<double>(i) / kSteps);
            chords.push_back({before, here - before});
            before = here;
        }
    }
    return chords;
}

double distance(AxisVecd p, const std::vector<Chord>& chords)
{
    double least = 1e18;
    for (const Chord& chord : chords) {
        const AxisVecd to = p - chord.start;
        const double square = dot(chord.along, chord.along);
        const double t = square > 0 ? std::clamp(dot(to, chord.along) / square, 0.0, 1.0) : 0.0;
        const AxisVecd off = to - chord.along * t;
        least = std::min(least, dot(off, off));
    }
    return std::sqrt(least);
}

// Chords of a curve of random waves.
std::vector<Position> random_curve(std::uint64_t seed, double spacing)
{
    std::mt19937_64 random{seed};
    std::uniform_real_distribution<double> part{0.2, 1};
    const double a = part(random);
    const double b = part(random);
    const double c = 3 * part(random);
    std::vector<Position> vertices;
    for (int i = 0; i < 160; ++i) {
        const double t = spacing * i;
        vertices.push_back(
            to_position(AxisVecd{t, 3 * a * std::sin(b * t), 0.5 * c * std::cos(0.7 * t)}));
    }
    return vertices;
}

}  // namespace

TEST_GROUP(LineSmoothers){};

TEST(LineSmoothers, KeepEveryVertexAndMiddleWithinTheirShare)
{
    const double allowed = static_cast<double>(kDeparture);
    for (std::uint64_t seed = 500; seed < 540; ++seed) {
        const auto vertices = random_curve(seed, 0.1 + 0.01 * static_cast<double>(seed % 7));
        const auto pieces = smoothed(vertices);
        CHECK(pieces.size() < vertices.size());
        const auto chords = chords_of(pieces);
        for (std::size_t i = 1; i < vertices.size(); ++i) {
            const AxisVecd here = to_millimetres(vertices[i]);
            const AxisVecd middle = (here + to_millimetres(vertices[i - 1])) * 0.5;
            const std::string which = "seed " + std::to_string(seed);
            CHECK_TEXT(distance(here, chords) <= allowed + 2e-6, which.c_str());
            CHECK_TEXT(distance(middle, chords) <= allowed + 2e-6, which.c_str());
        }
    }
}

TEST(LineSmoothers, MakeAChainFromTheFirstVertexToTheLast)
{
    const auto vertices = random_curve(3, 0.1);
    const auto pieces = smoothed(vertices);
    CHECK(pieces.front().start == vertices.front());
    CHECK(pieces.back().end == vertices.back());
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        CHECK(pieces[i].start == pieces[i - 1].end);
    }
}

TEST(LineSmoothers, MeetWithTheSameDirectionAndCurvature)
{
    unsigned joints = 0;
    for (std::uint64_t seed = 600; seed < 620; ++seed) {
        const auto pieces = smoothed(random_curve(seed, 0.1));
        for (std::size_t i = 1; i < pieces.size(); ++i) {
            // If the chord is off a bend by more than the tolerance, the lines stay.
            if (!std::holds_alternative<path::Quintic>(pieces[i - 1].path) ||
                !std::holds_alternative<path::Quintic>(pieces[i].path)) {
                continue;
            }
            ++joints;
            const planner::EndGeometry before = geometry_at(pieces[i - 1], true);
            const planner::EndGeometry after = geometry_at(pieces[i], false);
            const std::string which = "seed " + std::to_string(seed);
            CHECK_TEXT(norm(after.tangent - before.tangent) < 3e-6F, which.c_str());
            CHECK_TEXT(norm(after.curvature - before.curvature) < 1e-4F, which.c_str());
        }
    }
    CHECK_TEXT(joints > 200, std::to_string(joints).c_str());
}

// A circle of chords with five decimals: the curvature that one knot finds is that of the circle,
// and speed is one along the pieces.
TEST(LineSmoothers, FindACircle)
{
    constexpr double kRadius = 10;
    std::vector<Position> vertices;
    for (int i = 0; i < 200; ++i) {
        const double angle = 0.02 * i;
        Position at = to_position({kRadius * std::cos(angle), kRadius * std::sin(angle), 0});
        at.x -= at.x % 10;
        at.y -= at.y % 10;
        vertices.push_back(at);
    }
    for (const path::Move& piece : smoothed(vertices)) {
        for (const bool at_end : {false, true}) {
            const planner::EndGeometry geometry = geometry_at(piece, at_end);
            DOUBLES_EQUAL(1 / kRadius, static_cast<double>(norm(geometry.curvature)), 1e-3);
            DOUBLES_EQUAL(1, static_cast<double>(norm(geometry.tangent)), 1e-5);
        }
        constexpr int kSteps = 100;
        const double length = static_cast<double>(std::get<path::Quintic>(piece.path).length);
        for (int i = 0; i < kSteps; ++i) {
            const AxisVecd step =
                point_of(piece, (i + 1.0) / kSteps) - point_of(piece, i * 1.0 / kSteps);
            DOUBLES_EQUAL(1, norm(step) * kSteps / length, 6e-4);
        }
    }
}

TEST(LineSmoothers, RefuseWhatIsNoShortFeedLineWithATolerance)
{
    path::Move exact = line({}, {100'000, 0, 0});
    exact.tolerance = 0;
    CHECK(!LineSmoother::accepts(exact));
    path::Move rapid = line({}, {100'000, 0, 0});
    rapid.kind = path::MoveKind::kRapid;
    CHECK(!LineSmoother::accepts(rapid));
    CHECK(!LineSmoother::accepts(line({}, {5'000'000, 0, 0})));
}

// A corner that is cut there may count on it.
TEST(LineSmoothers, LeaveTheirEndsNoFasterThanTheyLean)
{
    constexpr int kSteps = 400;
    int curves = 0;
    for (std::uint64_t seed = 540; seed < 580; ++seed) {
        const auto vertices = random_curve(seed, 0.1);
        const auto pieces = smoothed(vertices);
        CHECK(pieces.size() > 1);
        for (const bool at_end : {false, true}) {
            const path::Move& piece = at_end ? pieces.back() : pieces.front();
            const path::PathLean& lean = at_end ? piece.end_lean : piece.start_lean;
            const AxisVecd from = to_millimetres(at_end ? vertices.back() : vertices.front());
            const AxisVecd to = to_millimetres(at_end ? *(vertices.end() - 2) : vertices[1]);
            if (lean.length <= 0) {
                CHECK(std::holds_alternative<path::Line>(piece.path) && piece.departure <= 0);
                continue;
            }
            DOUBLES_EQUAL(norm(to - from), static_cast<double>(lean.length), 1e-6);
            curves += std::holds_alternative<path::Quintic>(piece.path) ? 1 : 0;
            double travel = 0;
            double bend = 0;  // most so far, 1/mm
            AxisVecd before = from;
            AxisVecd direction{};
            for (int i = 1; i <= kSteps; ++i) {
                const double t = static_cast<double>(i) / kSteps;
                const AxisVecd here = point_of(piece, at_end ? 1 - t : t);
                const AxisVecd step = here - before;
                const AxisVecd along = step / norm(step);
                bend = i == 1 ? 0 : std::max(bend, norm(along - direction) / norm(step));
                travel += norm(step);
                if (travel > static_cast<double>(lean.length)) {
                    break;
                }
                const double allowed =
                    travel * (static_cast<double>(lean.slope) + 0.5 * travel * bend) + 3e-6;
                CHECK_TEXT(distance(here, {{from, to - from}}) <= allowed,
                           ("seed " + std::to_string(seed)).c_str());
                before = here;
                direction = along;
            }
        }
        CHECK(pieces[1].start_lean.length <= 0);
    }
    CHECK(curves > 60);
}

TEST(LineSmoothers, ACornerEndsTheRun)
{
    LineSmoother smoother;
    smoother.add(line({}, {100'000, 0, 0}), kDeparture);
    CHECK(!smoother.continues(line({100'000, 0, 0}, {100'000, 100'000, 0})));
    CHECK(smoother.continues(line({100'000, 0, 0}, {200'000, 10'000, 0})));
}

// Vertices are kept in 32 bits of nanometres from an origin, which follows a run of metres.
TEST(LineSmoothers, FollowsARunOfThreeMetres)
{
    constexpr int kLines = 1700;
    std::vector<Position> vertices;
    for (int i = 0; i <= kLines; ++i) {
        const double s = 1.8 * i;
        vertices.push_back(to_position({-500.0 - s, 10 * std::sin(s / 300), 0.01 * s}));
    }
    Position at = vertices.front();
    std::size_t passed = 0;
    for (const path::Move& piece : smoothed(vertices)) {
        CHECK(piece.start == at);
        at = piece.end;
        double nearest = 1e9;
        for (std::size_t i = passed + 1; i < std::min(passed + 50, vertices.size()); ++i) {
            const double off = norm(to_millimetres(vertices[i] - at));
            if (off < nearest) {
                nearest = off;
                passed = off < static_cast<double>(kTolerance) ? i : passed;
            }
        }
        CHECK_TEXT(nearest < static_cast<double>(kTolerance), std::to_string(passed).c_str());
    }
    CHECK(at == vertices.back());
    UNSIGNED_LONGS_EQUAL(kLines, passed);
}
