// Fitted moves against brute force: distances measured on the arc by dense sampling.
#include "firmware/segmenter/arc_fitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/path/move.hpp"

using namespace cusp;
using namespace cusp::segmenter;

namespace {

constexpr unsigned kSeed = 21;

std::vector<FittedMove> fit(const std::vector<Vec3d>& vertices,
                            const FitSettings& settings,
                            std::size_t capacity = 256)
{
    std::vector<Vec3d> buffer(capacity);
    ArcFitter fitter{settings, {buffer.data(), buffer.size()}};
    std::vector<FittedMove> moves;
    FittedMove move{};
    fitter.start(vertices[0]);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        while (!fitter.has_room()) {
            CHECK(fitter.next(move));
            moves.push_back(move);
        }
        fitter.push(vertices[i]);
    }
    fitter.finish();
    while (fitter.next(move)) {
        moves.push_back(move);
    }
    return moves;
}

// Points of a move as the controller makes them.
std::vector<Vec3d> samples(Vec3d start, const FittedMove& move)
{
    constexpr int kCount = 1000;
    std::vector<Vec3d> points;
    if (!move.is_arc) {
        for (int i = 0; i <= kCount; ++i) {
            points.push_back(start + (move.end - start) * (static_cast<double>(i) / kCount));
        }
        return points;
    }
    path::ArcWords words{};
    words.start = to_position(start);
    words.end = to_position(move.end);
    words.plane = move.plane;
    words.clockwise = move.clockwise;
    words.first_offset_nm = to_nanometres(move.first_offset);
    words.second_offset_nm = to_nanometres(move.second_offset);
    words.turns = 1;
    const Result<path::Arc> arc = path::make_arc(words);
    CHECK(static_cast<bool>(arc));
    DOUBLES_EQUAL(0, arc->radius_change, 0.0005 + 1e-6);
    for (int i = 0; i <= kCount; ++i) {
        const double t = static_cast<double>(i) / kCount;
        const double angle = t * arc->sweep;
        points.push_back(start + xyz(arc->centre +
                                     (arc->radius + t * arc->radius_change) *
                                         (std::cos(angle) * arc->u + std::sin(angle) * arc->v) +
                                     t * arc->axial));
    }
    return points;
}

double distance(Vec3d p, const std::vector<Vec3d>& path)
{
    double best = 1e9;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const Vec3d chord = path[i] - path[i - 1];
        const double square = dot(chord, chord);
        const double t =
            square > 0 ? std::clamp(dot(p - path[i - 1], chord) / square, 0.0, 1.0) : 0;
        best = std::min(best, norm(p - path[i - 1] - chord * t));
    }
    return best;
}

// Checks that the moves replace all lines and keep their vertices and middles.
void check(const std::vector<Vec3d>& vertices,
           const std::vector<FittedMove>& moves,
           double tolerance)
{
    constexpr double kSampling = 1e-5;
    std::size_t at = 0;
    for (const FittedMove& move : moves) {
        const std::vector<Vec3d> path = samples(vertices[at], move);
        double largest = 0;
        for (std::size_t i = at; i < at + move.lines; ++i) {
            const double vertex = distance(vertices[i + 1], path);
            const double between = distance(0.5 * (vertices[i] + vertices[i + 1]), path);
            CHECK_TEXT(vertex <= tolerance + kSampling, std::to_string(vertex).c_str());
            CHECK_TEXT(between <= 1.1 * tolerance + kSampling, std::to_string(between).c_str());
            largest = std::max({largest, vertex, between});
        }
        CHECK(largest <= move.deviation + kSampling);
        at += move.lines;
        CHECK(vertices[at] == move.end);
    }
    LONGS_EQUAL(vertices.size() - 1, at);
}

Vec3d rounded(Vec3d v)
{
    const auto step = [](double x) {
        return std::round(x * 1e4) / 1e4;
    };
    return {step(v.x), step(v.y), step(v.z)};
}

std::vector<Vec3d> circle(double radius, double turns, int count, unsigned first, unsigned second)
{
    std::vector<Vec3d> points;
    for (int i = 0; i <= count; ++i) {
        const double angle = 2 * 3.14159265358979 * turns * i / count;
        Vec3d p{};
        p[first] = radius * std::cos(angle);
        p[second] = radius * std::sin(angle);
        points.push_back(rounded(p));
    }
    return points;
}

}  // namespace

TEST_GROUP(ArcFitter)
{
    std::mt19937_64 random{kSeed};
    FitSettings settings;
};

TEST(ArcFitter, MakesACircleOfTwoArcsInEveryPlane)
{
    for (const auto& [first, second] : {std::pair{0U, 1U}, std::pair{2U, 0U}, std::pair{1U, 2U}}) {
        const std::vector<Vec3d> vertices = circle(20, 1, 360, first, second);
        const std::vector<FittedMove> moves = fit(vertices, settings, 512);
        LONGS_EQUAL(2, moves.size());
        CHECK(moves[0].is_arc);
        CHECK(!moves[0].clockwise);
        check(vertices, moves, settings.left);
    }
}

TEST(ArcFitter, MakesAHelixOfArcs)
{
    std::vector<Vec3d> vertices = circle(8, -2, 400, 0, 1);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i].z = std::round(-25.0 * static_cast<double>(i)) / 1e4;
    }
    const std::vector<FittedMove> moves = fit(vertices, settings);
    CHECK(moves.size() <= 4);
    check(vertices, moves, settings.left);
}

TEST(ArcFitter, KeepsCornersAndStraightLines)
{
    const std::vector<Vec3d> vertices = {{0, 0, 0},   {5, 0, 0},   {10, 0, 0},
                                         {10, 10, 0}, {10, 20, 5}, {0, 0, 0}};
    const std::vector<FittedMove> moves = fit(vertices, settings);
    LONGS_EQUAL(4, moves.size());
    check(vertices, moves, settings.left);
}

TEST(ArcFitter, NeverMergesAReversal)
{
    const std::vector<Vec3d> vertices = {{0, 0, 0}, {10, 0, 0}, {3, 0, 0}, {12, 0, 0}};
    LONGS_EQUAL(3, fit(vertices, settings).size());
}

TEST(ArcFitter, KeepsTinyLoopsThatNearlyClose)
{
    settings.left = settings.right = 0.1;
    for (const double radius : {0.05, 0.11, 0.3, 1.0}) {
        std::vector<Vec3d> vertices = {{-5, 0, 0}};
        for (const Vec3d& v : circle(radius, 1.02, 40, 0, 1)) {
            vertices.push_back(v);
        }
        vertices.push_back({5, 0, 0});
        check(vertices, fit(vertices, settings), settings.left);
    }
}

TEST(ArcFitter, StaysWithinToleranceOnRandomCurves)
{
    std::uniform_real_distribution<double> numbers{0.2, 3};
    for (int i = 0; i < 25; ++i) {
        const double a = numbers(random);
        const double b = numbers(random);
        const double c = numbers(random);
        const double size = std::pow(10, numbers(random) - 1);
        const bool deep = i % 3 == 0;
        std::vector<Vec3d> vertices;
        for (int k = 0; k < 300; ++k) {
            const double t = k * 0.01;
            vertices.push_back(rounded({size * std::sin(a * t), size * std::sin(b * t + c),
                                        deep ? size * std::cos(c * t) : 1.0}));
        }
        settings.left = settings.right = i % 2 == 0 ? 0.01 : 0.002;
        const std::vector<FittedMove> moves = fit(vertices, settings, 128);
        check(vertices, moves, settings.left);
    }
}

TEST(ArcFitter, StaysOnOneSideWhereOnlyOneIsGiven)
{
    settings.left = 0;
    settings.right = 0.02;
    std::vector<Vec3d> vertices;
    for (int k = 0; k <= 200; ++k) {
        const double t = k * 0.01;
        vertices.push_back({10 * t, 3 * std::sin(2 * t), 0});
    }
    const std::vector<FittedMove> moves = fit(vertices, settings);
    CHECK(moves.size() < 60);
    check(vertices, moves, 0.02);
    std::size_t at = 0;
    for (const FittedMove& move : moves) {
        const Vec3d start = vertices[at];
        for (std::size_t i = at; i < at + move.lines; ++i) {
            const Vec3d v = vertices[i + 1];
            if (move.is_arc) {
                const double radius = std::hypot(move.first_offset, move.second_offset);
                const double off = std::hypot(v.x - start.x - move.first_offset,
                                              v.y - start.y - move.second_offset) -
                                   radius;
                // Right of the motion is inside a clockwise arc; the radii differ by the rounding.
                CHECK((move.clockwise ? -off : off) >= -2e-4);
            }
        }
        at += move.lines;
    }
}

TEST(ArcFitter, UsesNoArcThatIsTooSmallOrTooFlat)
{
    const std::vector<Vec3d> tiny = circle(0.003, 0.5, 20, 0, 1);
    settings.left = settings.right = 1e-5;
    for (const FittedMove& move : fit(tiny, settings)) {
        CHECK(!move.is_arc);
    }
    std::vector<Vec3d> flat;
    for (int i = 0; i <= 100; ++i) {
        flat.push_back({i * 1.0, i * i * 1e-5, 0});
    }
    settings.greatest_radius = 1000;
    for (const FittedMove& move : fit(flat, settings)) {
        CHECK(!move.is_arc);
    }
}
