// The clocks against a model of theirs, whole or broken.
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

constexpr cusp::hal::stm32f4::ClockPlan kPlan{8000000, 168000000, 5, 2, 4, 1};
static_assert(kPlan.fast_bus_hz() == 84000000 && kPlan.slow_bus_hz() == 42000000);
static_assert(kPlan.fast_timer_hz() == 168000000 && kPlan.slow_timer_hz() == 84000000);

}  // namespace

TEST_GROUP(ClockTree) { ChipModel chip; };

TEST(ClockTree, GivesUpOnAMultiplierThatNeverLocks)
{
    CHECK_TRUE(start_clocks<ModelChip>(kPlan) == ClockSource::kNone);
}

TEST(ClockTree, RunsFromTheCrystal)
{
    chip.crystal_works = chip.multiplier_works = true;
    CHECK_TRUE(start_clocks<ModelChip>(kPlan) == ClockSource::kCrystal);
    // 8 MHz by 8, times 336, by 2; the slow bus by 4, the fast one by 2.
    LONGS_EQUAL(8, chip.rcc.pllcfgr.value & 0x3FU);
    LONGS_EQUAL(336, chip.rcc.pllcfgr.value >> 6U & 0x1FFU);
    LONGS_EQUAL(0, chip.rcc.pllcfgr.value >> 16U & 3U);
    LONGS_EQUAL(1, chip.rcc.pllcfgr.value >> 22U & 1U);
    LONGS_EQUAL(5, chip.rcc.cfgr.value >> 10U & 7U);
    LONGS_EQUAL(4, chip.rcc.cfgr.value >> 13U & 7U);
    LONGS_EQUAL(2, chip.rcc.cfgr.value & 3U);
    LONGS_EQUAL(0, chip.violations);
}

TEST(ClockTree, MakesTheSameRateFromTheOscillator)
{
    // The crystal never starts: the oscillator's 16 MHz by 16, times 336, by 2.
    chip.multiplier_works = true;
    CHECK_TRUE(start_clocks<ModelChip>(kPlan) == ClockSource::kNoCrystal);
    LONGS_EQUAL(16, chip.rcc.pllcfgr.value & 0x3FU);
    LONGS_EQUAL(336, chip.rcc.pllcfgr.value >> 6U & 0x1FFU);
    LONGS_EQUAL(0, chip.rcc.pllcfgr.value >> 22U & 1U);
    LONGS_EQUAL(0, chip.violations);
}

TEST(ClockTree, DoesNotRunFromACrystalThatIsNotThePlannedOne)
{
    for (const std::uint32_t hz : {25000000U, 12000000U, 6000000U, 16000000U}) {
        ChipModel other;
        other.crystal_works = other.multiplier_works = true;
        other.crystal_hz = hz;
        CHECK_TRUE(start_clocks<ModelChip>(kPlan) == ClockSource::kOtherCrystal);
        LONGS_EQUAL(16, other.rcc.pllcfgr.value & 0x3FU);
        LONGS_EQUAL(0, other.rcc.cr.value >> 16U & 1U);
        LONGS_EQUAL(0, other.violations);
    }
    ChipModel::current = &chip;
}

TEST(ClockTree, HasTheCrystalWatched)
{
    chip.crystal_works = chip.multiplier_works = true;
    static_cast<void>(start_clocks<ModelChip>(kPlan));
    LONGS_EQUAL(1, chip.rcc.cr.value >> 19U & 1U);
}

TEST(ClockTree, StartsAnewWhereABootLoaderLeftItsOwnClocks)
{
    chip.crystal_works = chip.multiplier_works = true;
    static_cast<void>(start_clocks<ModelChip>({8000000, 96000000, 5, 2, 4, 1}));
    CHECK_TRUE(start_clocks<ModelChip>(kPlan) == ClockSource::kCrystal);
    LONGS_EQUAL(336, chip.rcc.pllcfgr.value >> 6U & 0x1FFU);
    LONGS_EQUAL(0, chip.violations);
}
