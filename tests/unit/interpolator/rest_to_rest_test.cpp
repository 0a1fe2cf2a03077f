// Straight moves from rest to rest take the time of the closed form.
#include <algorithm>
#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/motion_rig.hpp"

using namespace cusp;
using cusp::test::MotionRig;

namespace {

constexpr double kFilter = 0.02;  // a/j of the default settings, s

path::Move line(Position start, Position end, float feed, float tolerance)
{
    path::Move move;
    move.start = start;
    move.end = end;
    move.feed = feed;
    move.tolerance = tolerance;
    return move;
}

// Time in which the set points move, s.
double moving_time(const std::vector<Position>& samples)
{
    std::size_t first = 0;
    while (samples[first] == Position{}) {
        ++first;
    }
    std::size_t last = samples.size() - 1;
    while (samples[last - 1] == samples.back()) {
        --last;
    }
    return 1e-3 * static_cast<double>(last - first + 1);
}

// With a fixed filter between acceleration and its change: v/a to speed up, twice the filter to
// ramp the acceleration, and where the speed is not reached a rest of one filter between.
double closed_form(double length, double speed, double acceleration, double filter = kFilter)
{
    const double cruise = length - speed * (speed / acceleration + filter);
    if (cruise >= 0) {
        return length / speed + speed / acceleration + filter;
    }
    // l = v (v/a + filter)
    const double top =
        0.5 * acceleration * (std::sqrt(filter * filter + 4 * length / acceleration) - filter);
    return length / top + top / acceleration + filter;
}

}  // namespace

TEST_GROUP(RestToRest){};

TEST(RestToRest, WithinTenMillisecondsOfTheClosedForm)
{
    for (const double length : {0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 40.0, 100.0}) {
        for (const float feed : {10.0F, 50.0F, 100.0F}) {
            const Position end = to_position(Vec3d{length, 0, 0});
            MotionRig rig;
            rig.start_at({});
            const double time = moving_time(rig.run({line({}, end, feed, 0)}));
            const double ideal = closed_form(length, static_cast<double>(feed), 1000);
            CHECK(time <= ideal + 0.010);
            CHECK(time >= ideal - 0.002);
        }
    }
}

// A filter of 150 ms reaches beyond the end of each move.
TEST(RestToRest, ShortMovesOfAStrongMachineWithLittleJerk)
{
    MachineLimits limits;
    for (unsigned axis = 0; axis < 3; ++axis) {
        limits.velocity[axis] = 100;
        limits.acceleration[axis] = 6000;
        limits.jerk[axis] = 40000;
    }
    for (const double length : {0.002, 0.02, 0.15, 0.5}) {
        for (const float feed : {0.5F, 2.0F, 20.0F}) {
            const Position end = to_position(Vec3d{length, 0, 0});
            MotionRig rig{limits};
            rig.start_at({});
            const double time = moving_time(rig.run({line({}, end, feed, 0)}));
            const double ideal = closed_form(length, static_cast<double>(feed), 6000, 0.15);
            CHECK(time <= 1.03 * ideal + 0.010);
        }
    }
}

TEST(RestToRest, AStopOnTheExactPathCostsOneFilterAndATick)
{
    const auto zigzag = [](int lines, float tolerance) {
        std::vector<path::Move> moves;
        Position at{};
        for (int i = 0; i < lines; ++i) {
            Position next = at;
            next[static_cast<unsigned>(i % 2)] += 50'000'000;
            moves.push_back(line(at, next, 100, tolerance));
            at = next;
        }
        return moves;
    };
    const auto time_of = [&](int lines, float tolerance) {
        MotionRig rig;
        rig.start_at({});
        return moving_time(rig.run(zigzag(lines, tolerance)));
    };
    const double exact = (time_of(12, 0) - time_of(2, 0)) / 10;
    CHECK(exact <= 0.5 + 0.1 + kFilter + 0.002);
    // Within a tolerance of 10 um a right angle overlaps by 17 ticks.
    const double cut = (time_of(12, 0.01F) - time_of(2, 0.01F)) / 10;
    CHECK(cut <= exact - 0.015);
}
