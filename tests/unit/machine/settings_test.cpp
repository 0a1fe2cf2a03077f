#include "firmware/machine/settings.hpp"

#include <optional>
#include <variant>

#include "CppUTest/TestHarness.h"

using namespace cusp::machine;
using cusp::Error;

TEST_GROUP(MachineSettings) { Settings settings; };

TEST(MachineSettings, AreAThreeAxisMillByDefault)
{
    CHECK_FALSE(settings.find_fault().has_value());
    const cusp::MachineLimits standard;
    CHECK(settings.limits() == standard);
    UNSIGNED_LONGS_EQUAL(800000, settings.steps().millisteps_per_mm[2]);
    UNSIGNED_LONGS_EQUAL(2, settings.steps().pulse_us);
    UNSIGNED_LONGS_EQUAL(5, settings.steps().direction_setup_us);
}

TEST(MachineSettings, AreListedWithGrblsOwnFirst)
{
    bool foreign = false;
    unsigned last = 0;
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        const unsigned number = setting_entry(i).number;
        const bool is_foreign = number == 8 || (number >= 14 && number <= 16) || number == 29 ||
                                (number >= 33 && number <= 37) || (number >= 44 && number <= 46) ||
                                number > 132;
        CHECK(is_foreign || !foreign);
        CHECK(is_foreign || i == 0 || number > last);
        foreign = is_foreign;
        last = number;
    }
}

TEST(MachineSettings, RefuseStepsTooCloseForThePulse)
{
    // 250 000 steps/s are 4 us apart: twice the pulse of 2 us, and no closer.
    CHECK(!settings.put(110, 18750));
    CHECK_FALSE(settings.find_fault().has_value());
    CHECK(!settings.put(110, 18751));
    const auto fault = settings.find_fault();
    CHECK(fault.has_value());
    CHECK(fault->error == Error::kMaxStepRateExceeded);
    UNSIGNED_LONGS_EQUAL(110, fault->first);
    UNSIGNED_LONGS_EQUAL(100, fault->second);
}

TEST(MachineSettings, RefuseMoreStepsThanTheBoardPlays)
{
    // 6000 mm/min at 800 steps/mm are 80 000 steps/s.
    CHECK_FALSE(settings.find_fault({80000}).has_value());
    const auto fault = settings.find_fault({79999});
    CHECK(fault.has_value());
    CHECK(fault->error == Error::kMaxStepRateExceeded);
    CHECK(fault->of_board);
    UNSIGNED_LONGS_EQUAL(110, fault->first);
    UNSIGNED_LONGS_EQUAL(100, fault->second);
    DOUBLES_EQUAL(80000, fault->amount, 0);
    DOUBLES_EQUAL(79999, fault->limit, 0);
    CHECK_FALSE(settings.sound({79999}));
}

TEST(MachineSettings, RefuseAFilterOverAQuarterSecond)
{
    CHECK(!settings.put(802, 2000));
    CHECK_FALSE(settings.find_fault().has_value());
    CHECK(!settings.put(802, 1999));
    const auto fault = settings.find_fault();
    CHECK(fault.has_value());
    UNSIGNED_LONGS_EQUAL(122, fault->first);
    UNSIGNED_LONGS_EQUAL(802, fault->second);
}

TEST(MachineSettings, SwitchOffSoftLimitsWithHoming)
{
    CHECK(!settings.put(22, 1));
    CHECK(!settings.put(20, 1));
    CHECK(!settings.put(22, 0));
    CHECK_FALSE(settings.on(Setting::kSoftLimits));
}

TEST(MachineSettings, RefuseValuesOutsideTheirRange)
{
    CHECK(settings.put(0, 0) == Error::kSettingStepPulseMin);
    CHECK(settings.put(0, 101) == Error::kGcodeMaxValueExceeded);
    CHECK(settings.put(120, 0) == Error::kNegativeValue);
    CHECK(settings.put(10, -1) == Error::kNegativeValue);
    CHECK(settings.put(7, 1) == Error::kInvalidStatement);
    CHECK(!settings.put(21, 5));
    DOUBLES_EQUAL(1.0, static_cast<double>(settings.value(Setting::kHardLimits)), 0);
}

TEST(MachineSettings, AreSoundByDefaultAndNotWhenTheyConflict)
{
    CHECK(settings.sound());
    CHECK(!settings.put(100, 10000));
    CHECK_FALSE(settings.sound());
}
