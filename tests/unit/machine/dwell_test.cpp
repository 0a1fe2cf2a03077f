// The clock of G4 against one that counts slices.
#include "firmware/machine/dwell.hpp"

#include "CppUTest/TestHarness.h"

namespace cusp::machine {
namespace {

// Ticks until it is over, asked each tick from `from` on.
std::uint32_t asked_each_tick(Dwell& dwell, std::uint32_t from)
{
    std::uint32_t ticks = 0;
    while (!dwell.over(from + ticks)) {
        ++ticks;
    }
    return ticks;
}

}  // namespace

TEST_GROUP(Dwell){};

TEST(Dwell, LastsItsTimeToTheNearestTick)
{
    for (const double seconds : {0.0, 0.0004, 0.0006, 0.25, 3.0}) {
        Dwell dwell;
        dwell.begin(seconds, 100);
        CHECK_EQUAL(static_cast<std::uint32_t>(seconds * 1000 + 0.5), asked_each_tick(dwell, 100));
    }
}

TEST(Dwell, GoesOnWhereTheTickCounterWraps)
{
    Dwell dwell;
    dwell.begin(0.5, 0xFFFFFF00U);
    CHECK_EQUAL(500U, asked_each_tick(dwell, 0xFFFFFF00U));
}

TEST(Dwell, StandsWhileNobodyAsks)
{
    Dwell dwell;
    dwell.begin(0.1, 0);
    for (std::uint32_t tick = 0; tick <= 40; ++tick) {
        CHECK_FALSE(dwell.over(tick));
    }
    // A hold of 1000 ticks counts as one.
    CHECK_EQUAL(59U, asked_each_tick(dwell, 1040));
}

}  // namespace cusp::machine
