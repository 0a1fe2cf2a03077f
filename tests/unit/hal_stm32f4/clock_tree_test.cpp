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

TEST_GROUP(ClockTree) { ChipModel chip; };

TEST(ClockTree, GivesUpOnAMultiplierThatNeverLocks)
{
    CHECK_TRUE(start_clocks<ModelChip>(8000000) == ClockSource::kNone);
}

TEST(ClockTree, MakesTheSameRateFromEitherSource)
{
    // The crystal never starts: the oscillator's 16 MHz by 8.
    static_cast<void>(start_clocks<ModelChip>(8000000));
    LONGS_EQUAL(8, chip.rcc.pllcfgr.value & 0x3FU);
    LONGS_EQUAL(168, chip.rcc.pllcfgr.value >> 6U & 0x1FFU);
}
