// Ticks are counted for the tool of the line that is executed, not of the line that is read.
#include "host_tools/controller/program_run/tool_times.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;

TEST_GROUP(ToolTimes)
{
    program_run::ToolTimes times;

    void tick(std::uint32_t line, int count)
    {
        for (int n = 0; n < count; ++n) {
            times.add_tick(line);
        }
    }
    void check(std::size_t place, int number, std::uint64_t ticks)
    {
        LONGS_EQUAL(number, times.times().at(place).number);
        LONGS_EQUAL(ticks, times.times().at(place).ticks);
    }
};

TEST(ToolTimes, AToolsTimeBeginsWhereItsLinesAreExecuted)
{
    times.read_line(1, 0);
    times.read_line(2, 3);
    times.read_line(3, 3);
    times.read_line(4, 5);
    tick(1, 10);
    tick(3, 20);
    tick(6, 7);
    LONGS_EQUAL(2, times.times().size());
    check(0, 3, 30);
    check(1, 5, 7);
    LONGS_EQUAL(1, times.changes());
}

TEST(ToolTimes, AToolThatComesBackIsCountedOn)
{
    times.read_line(1, 1);
    times.read_line(10, 2);
    times.read_line(20, 1);
    tick(2, 5);
    tick(11, 6);
    tick(21, 8);
    LONGS_EQUAL(2, times.times().size());
    check(0, 1, 13);
    check(1, 2, 6);
    LONGS_EQUAL(2, times.changes());
}

TEST(ToolTimes, AToolWithoutAMoveHasNoTime)
{
    times.read_line(1, 1);
    times.read_line(2, 2);
    times.read_line(3, 4);
    tick(4, 3);
    check(0, 1, 0);
    check(1, 2, 0);
    check(2, 4, 3);
    LONGS_EQUAL(2, times.changes());
}

TEST(ToolTimes, AProgramWithoutToolsHasOneOfNoNumber)
{
    times.read_line(1, 0);
    tick(1, 4);
    LONGS_EQUAL(1, times.times().size());
    check(0, 0, 4);
    LONGS_EQUAL(0, times.changes());
}
