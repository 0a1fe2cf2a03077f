// The clocks against registers that never change, which is a chip whose crystal is broken.
#include "hal/stm32f4/clock_tree.hpp"

#include <map>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_stm32f4/chip_model.hpp"

using cusp::hal::stm32f4::ClockSource;
using cusp::hal::stm32f4::start_clocks;
using cusp::test::ChipModel;
using cusp::test::ModelChip;

namespace {

constexpr cusp::hal::stm32f4::ClockPlan kPlan{8000000, 168000000, 5, 2, 4};
static_assert(kPlan.fast_bus_hz() == 84000000 && kPlan.slow_bus_hz() == 42000000);
static_assert(kPlan.fast_timer_hz() == 168000000 && kPlan.slow_timer_hz() == 84000000);

}  // namespace

TEST_GROUP(ClockTree) { ChipModel chip; };

TEST(ClockTree, GivesUpOnAMultiplierThatNeverLocks)
{
    CHECK_TRUE(start_clocks<ModelChip>(kPlan) == ClockSource::kNone);
}

TEST(ClockTree, MakesTheSameRateFromEitherSource)
{
    // The crystal never starts: the oscillator's 16 MHz by 16, times 336, by 2.
    static_cast<void>(start_clocks<ModelChip>(kPlan));
    LONGS_EQUAL(16, chip.rcc.pllcfgr.value & 0x3FU);
    LONGS_EQUAL(336, chip.rcc.pllcfgr.value >> 6U & 0x1FFU);
}
