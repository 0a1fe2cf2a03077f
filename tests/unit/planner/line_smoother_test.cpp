// Short lines of a curve become arcs that keep to every vertex and every middle.
#include "firmware/planner/line_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using planner::LineSmoother;

namespace {

constexpr float kTolerance = 0.01F;

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
        smoother.add(next);
    }
    while (smoother.next(LineSmoother::Patience::kNone, piece)) {
        pieces.push_back(piece);
    }
    return pieces;
}

Vec3d point_of(const path::Move& move, double t)
{
    const Vec3d start = to_millimetres(move.start);
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        return start + arc->centre + arc->u * (arc->radius * std::cos(t * arc->sweep)) +
               arc->v * (arc->radius * std::sin(t * arc->sweep));
    }
    return start + (to_millimetres(move.end) - start) * t;
}

struct Chord {
    Vec3d start;
    Vec3d along;
};

std::vector<Chord> chords_of(const std::vector<path::Move>& pieces)
{
    constexpr int kSteps = 200;
    std::vector<Chord> chords;
    for (const path::Move& piece : pieces) {
        Vec3d before = point_of(piece, 0);
        for (int i = 1; i <= kSteps; ++i) {
            const Vec3d here = point_of(piece, static_cast<double>(i) / kSteps);
            chords.push_back({before, here - before});
            before = here;
        }
    }
    return chords;
}

double distance(Vec3d p, const std::vector<Chord>& chords)
{
    double least = 1e18;
    for (const Chord& chord : chords) {
        const Vec3d to = p - chord.start;
        const double square = dot(chord.along, chord.along);
        const double t = square > 0 ? std::clamp(dot(to, chord.along) / square, 0.0, 1.0) : 0.0;
        const Vec3d off = to - chord.along * t;
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
            to_position(Vec3d{t, 3 * a * std::sin(b * t), 0.5 * c * std::cos(0.7 * t)}));
    }
    return vertices;
}

}  // namespace

TEST_GROUP(LineSmoothers){};

TEST(LineSmoothers, KeepEveryVertexAndMiddleWithinTheirShare)
{
    const double allowed = static_cast<double>(LineSmoother::kShareOfTolerance * kTolerance);
    for (std::uint64_t seed = 500; seed < 540; ++seed) {
        const auto vertices = random_curve(seed, 0.1 + 0.01 * static_cast<double>(seed % 7));
        const auto pieces = smoothed(vertices);
        CHECK(pieces.size() < vertices.size());
        const auto chords = chords_of(pieces);
        for (std::size_t i = 1; i < vertices.size(); ++i) {
            const Vec3d here = to_millimetres(vertices[i]);
            const Vec3d middle = (here + to_millimetres(vertices[i - 1])) * 0.5;
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

TEST(LineSmoothers, ACornerEndsTheRun)
{
    LineSmoother smoother;
    smoother.add(line({}, {100'000, 0, 0}));
    CHECK(!smoother.continues(line({100'000, 0, 0}, {100'000, 100'000, 0})));
    CHECK(smoother.continues(line({100'000, 0, 0}, {200'000, 10'000, 0})));
}
