// Distances to the programmed path.
#include "host_tools/controller/program_run/path_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"

namespace {

using namespace cusp;

path::Move line(Position start, Position end, std::uint32_t number = 1)
{
    path::Move move;
    move.start = start;
    move.end = end;
    move.line = number;
    return move;
}

// Helix about an axis along z, from angle 0.
path::Move helix(double radius, double radius_change, double sweep, double rise)
{
    path::Move move;
    move.path = path::Arc{{-radius, 0, 0}, {1, 0, 0},     {0, 1, 0}, {0, 0, rise},
                          radius,          radius_change, sweep};
    move.end = {1, 1, 1};
    return move;
}

AxisVecd helix_point(const path::Arc& arc, double t)
{
    const double r = arc.radius + t * arc.radius_change;
    return arc.centre + arc.u * (r * std::cos(t * arc.sweep)) +
           arc.v * (r * std::sin(t * arc.sweep)) + arc.axial * t;
}

double distance_of(const path::Move& move, Position point)
{
    return program_run::nearest_place(move, point).distance;
}

}  // namespace

TEST_GROUP(PathDeviation){};

TEST(PathDeviation, OfALineIsTheDistanceToItsNearestPoint)
{
    const path::Move move = line({0, 0, 0}, {3'000'000, 4'000'000, 0});
    DOUBLES_EQUAL(0.0, distance_of(move, {1'500'000, 2'000'000, 0}), 1e-12);
    DOUBLES_EQUAL(5.0, distance_of(move, {-3'000'000, -4'000'000, 0}), 1e-12);
    DOUBLES_EQUAL(2.0, distance_of(move, {3'000'000, 4'000'000, 2'000'000}), 1e-12);
}

TEST(PathDeviation, OfAHelixIsTheDistanceToItsNearestSample)
{
    const unsigned seed = 7;
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> unit{0.0, 1.0};
    for (int round = 0; round < 100; ++round) {
        // Drawn one by one: arguments of a call have no order.
        const double radius = 1.0 + 9.0 * unit(random);
        const double change = 0.1 * unit(random) - 0.05;
        const double sweep = 0.1 + 15.0 * unit(random);
        const path::Move move =
            helix(radius, change, sweep, round % 2 == 0 ? 0.0 : 5.0 * unit(random));
        const auto& arc = std::get<path::Arc>(move.path);
        const AxisVecd off{0.2 * unit(random), 0.2 * unit(random), 0.2 * unit(random)};
        const Position point = to_position(helix_point(arc, unit(random)) + off);
        double sampled = 1e9;
        for (int i = 0; i <= 200'000; ++i) {
            sampled =
                std::min(sampled, norm(helix_point(arc, i / 200'000.0) - to_millimetres(point)));
        }
        DOUBLES_EQUAL(sampled, distance_of(move, point), 2e-6);
    }
}

TEST(PathDeviation, OfABezierPieceIsTheDistanceToItsCurve)
{
    path::Move move;
    path::BezierPiece piece{};
    piece.order = 3;
    piece.points[1] = {1.0F, 0.0F, 0.0F};
    piece.points[2] = {1.0F, 1.0F, 0.0F};
    piece.weights[0] = piece.weights[2] = 1.0F;
    piece.weights[1] = 0.70710678F;  // a quarter of a circle about (0, 1)
    move.path = piece;
    move.end = {1'000'000, 1'000'000, 0};
    for (int i = 0; i <= 100; ++i) {
        const double angle = i / 100.0 * 1.5707963;
        const AxisVecd p{1.01 * std::sin(angle), 1.0 - 1.01 * std::cos(angle), 0.0};
        DOUBLES_EQUAL(0.01, distance_of(move, to_position(p)), 1e-6);
    }
}

TEST(PathDeviation, FollowsThePathAndNotItsNeighbourhood)
{
    // Out along x and back 5 mm above. A tool that repeats the outward path instead of the return path
    // is 5 mm off, though it is on the path all the time.
    program_run::PathDeviation deviation;
    deviation.add_move(line({0, 0, 0}, {10'000'000, 0, 0}, 1));
    deviation.add_move(line({10'000'000, 0, 0}, {10'000'000, 5'000'000, 0}, 2));
    deviation.add_move(line({10'000'000, 5'000'000, 0}, {0, 5'000'000, 0}, 3));
    const auto walk = [&deviation](Position from, Position to) {
        for (std::int64_t i = 0; i <= 100; ++i) {
            deviation.add_set_point(
                {from.x + (to.x - from.x) * i / 100, from.y + (to.y - from.y) * i / 100, 0});
        }
    };
    walk({0, 0, 0}, {10'000'000, 0, 0});
    walk({10'000'000, 0, 0}, {10'000'000, 5'000'000, 0});
    walk({10'000'000, 5'000'000, 0}, {5'000'000, 5'000'000, 0});
    DOUBLES_EQUAL(0.0, deviation.greatest(), 1e-12);
    walk({5'000'000, 5'000'000, 0}, {5'000'000, 0, 0});
    DOUBLES_EQUAL(5.0, deviation.greatest(), 1e-9);
    LONGS_EQUAL(3, deviation.line());
}

TEST(PathDeviation, KnowsWhichTurnOfAFlatArcTheToolIsIn)
{
    // Turns lie on each other: by place alone the line after them would be far away.
    path::ArcWords words{};
    words.start = {42'000'000, 30'000'000, 0};
    words.end = words.start;
    words.clockwise = true;
    words.second_offset_nm = 8'000'000;
    for (std::int32_t turns = 1; turns <= 4; ++turns) {
        words.turns = turns;
        program_run::PathDeviation deviation;
        path::Move circles;
        circles.path = *path::make_arc(words);
        circles.start = words.start;
        circles.end = words.end;
        deviation.add_move(circles);
        deviation.add_move(line(words.end, {0, 0, 0}, 2));
        constexpr int kSteps = 400;
        for (int i = 0; i <= turns * kSteps; ++i) {
            const double angle = 2 * kPi * i / kSteps;
            deviation.add_set_point(
                words.start + to_position({-8 * std::sin(angle), 8 - 8 * std::cos(angle), 0}));
        }
        for (int i = 0; i <= kSteps; ++i) {
            deviation.add_set_point({42'000'000 - 105'000 * i, 30'000'000 - 75'000 * i, 0});
        }
        DOUBLES_EQUAL(0.0, deviation.greatest(), 1e-6);
    }
}

TEST(PathDeviation, FollowsThereAndBackAgainOnTheSameLine)
{
    program_run::PathDeviation deviation;
    Position at{};
    for (std::uint32_t stroke = 1; stroke <= 6; ++stroke) {
        const Position next{stroke % 2 == 0 ? 0 : 20'000'000, 0, 0};
        deviation.add_move(line(at, next, stroke));
        at = next;
    }
    deviation.add_move(line({0, 0, 0}, {0, 9'000'000, 0}, 7));
    for (int stroke = 1; stroke <= 6; ++stroke) {
        for (std::int64_t i = 0; i <= 400; ++i) {
            deviation.add_set_point({stroke % 2 == 0 ? 20'000'000 - i * 50'000 : i * 50'000, 0, 0});
        }
    }
    for (std::int64_t i = 0; i <= 90; ++i) {
        deviation.add_set_point({0, i * 100'000, 0});
    }
    DOUBLES_EQUAL(0.0, deviation.greatest(), 1e-12);
}

TEST(PathDeviation, GoesOnElsewhereAfterARestart)
{
    program_run::PathDeviation deviation;
    deviation.add_move(line({0, 0, 0}, {0, 0, -20'000'000}, 1));
    for (std::int64_t i = 0; i <= 50; ++i) {
        deviation.add_set_point({0, 0, -i * 100'000});  // a probe that stops at -5
    }
    deviation.restart();
    deviation.add_move(line({0, 0, -5'000'000}, {1'000'000, 0, -5'000'000}, 2));
    deviation.add_set_point({500'000, 0, -5'000'000});
    DOUBLES_EQUAL(0.0, deviation.greatest(), 1e-12);
}

TEST(PathDeviation, ForgetsMovesThatAreLongPast)
{
    program_run::PathDeviation deviation;
    for (std::int64_t i = 0; i < 10; ++i) {
        deviation.add_move(line({i * 1'000'000, 0, 0}, {(i + 1) * 1'000'000, 0, 0},
                                static_cast<std::uint32_t>(i) + 1U));
    }
    for (std::int64_t tick = 0; tick <= 1000; ++tick) {
        deviation.add_set_point({tick * 10'000, 0, 0});
    }
    DOUBLES_EQUAL(0.0, deviation.greatest(), 1e-12);
    deviation.add_set_point({1'000'000, 0, 0});  // a leap back to a place of line 1
    CHECK(deviation.greatest() > 4.0);
}
