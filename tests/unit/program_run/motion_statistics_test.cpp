// Speed, acceleration and jerk of set points.
#include "host_tools/controller/program_run/motion_statistics.hpp"

#include "CppUTest/TestHarness.h"

using cusp::Position;
using cusp::program_run::MotionStatistics;

TEST_GROUP(MotionStatistics) { MotionStatistics statistics{Position{}}; };

TEST(MotionStatistics, AreZeroAtRest)
{
    statistics.add({});
    statistics.add({});
    statistics.finish();
    LONGS_EQUAL(0, statistics.moving_ticks());
    LONGS_EQUAL(2, statistics.ticks());
    DOUBLES_EQUAL(0.0, statistics.max_jerk().x, 0.0);
}

TEST(MotionStatistics, CountFromTheFirstToTheLastTickThatMoves)
{
    for (const std::int64_t x : {0, 0, 5, 5, 9, 9, 9}) {
        statistics.add({x, 0, 0});
    }
    LONGS_EQUAL(3, statistics.moving_ticks());
}

TEST(MotionStatistics, SeeTheStopAtTheEnd)
{
    // 1 um in one tick, then at rest: 1 mm/s, 1000 mm/s^2 up and down, 2e6 mm/s^3 between them.
    statistics.add({0, -1000, 0});
    statistics.finish();
    DOUBLES_EQUAL(1.0, statistics.max_velocity().y, 1e-12);
    DOUBLES_EQUAL(1000.0, statistics.max_acceleration().y, 1e-9);
    DOUBLES_EQUAL(2e6, statistics.max_jerk().y, 1e-6);
    DOUBLES_EQUAL(0.0, statistics.max_velocity().x, 0.0);
    DOUBLES_EQUAL(0.001, statistics.length(), 1e-15);
}
