// Straight moves from rest to rest take little more than the least time that the limits allow.
#include <algorithm>
#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/planner/station.hpp"
#include "tests/support/motion_rig.hpp"

using namespace cusp;
using cusp::test::MotionRig;

namespace {

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

// From rest to a speed with the greatest jerk and acceleration, s; the way is half of that at the speed.
double ramp_time(double speed, double acceleration, double jerk)
{
    return speed < acceleration * acceleration / jerk ? 2 * std::sqrt(speed / jerk)
                                                      : speed / acceleration + acceleration / jerk;
}

// The least time from rest to rest that the limits allow, s.
double least_time(double length, double speed, double acceleration, double jerk)
{
    const auto way = [&](double top) {
        return top * ramp_time(top, acceleration, jerk);
    };
    if (way(speed) <= length) {
        return 2 * ramp_time(speed, acceleration, jerk) + (length - way(speed)) / speed;
    }
    double low = 0;
    for (int i = 0; i < 60; ++i) {
        const double top = 0.5 * (low + speed);
        (way(top) < length ? low : speed) = top;
    }
    return 2 * ramp_time(low, acceleration, jerk);
}

}  // namespace

TEST_GROUP(RestToRest){};

TEST(RestToRest, WithinEightMillisecondsOfTheLeastTime)
{
    for (const double length : {0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 40.0, 100.0}) {
        for (const float feed : {10.0F, 50.0F, 100.0F}) {
            const Position end = to_position(AxisVecd{length, 0, 0});
            MotionRig rig;
            rig.start_at({});
            const double time = moving_time(rig.run({line({}, end, feed, 0)}));
            const double ideal = least_time(length, static_cast<double>(feed), 1000, 50000);
            CHECK(time <= ideal + 0.008);
            CHECK(time >= ideal - 0.002);
        }
    }
}

// The acceleration takes 150 ms to its greatest, longer than each move.
TEST(RestToRest, ShortMovesOfAStrongMachineWithLittleJerk)
{
    MachineLimits limits;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        limits.velocity[axis] = 100;
        limits.acceleration[axis] = 6000;
        limits.jerk[axis] = 40000;
    }
    for (const double length : {0.002, 0.02, 0.15, 0.5}) {
        for (const float feed : {0.5F, 2.0F, 20.0F}) {
            const Position end = to_position(AxisVecd{length, 0, 0});
            MotionRig rig{limits};
            rig.start_at({});
            const double time = moving_time(rig.run({line({}, end, feed, 0)}));
            const double ideal = least_time(length, static_cast<double>(feed), 6000, 40000);
            CHECK(time <= 1.03 * ideal + 0.006);
        }
    }
}

// The least time by the share of the limits that a plan uses, and two ticks.
TEST(RestToRest, AStopOnTheExactPathCostsWhatRestToRestTakes)
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
    const double share = static_cast<double>(planner::kPlanShare);
    CHECK(exact <= least_time(50, 100, 1000 * share, 50000 * share) + 0.002);
    CHECK(exact >= least_time(50, 100, 1000, 50000));
    // Within a tolerance of 10 um a right angle overlaps by 17 ticks.
    const double cut = (time_of(12, 0.01F) - time_of(2, 0.01F)) / 10;
    CHECK(cut <= exact - 0.015);
}
