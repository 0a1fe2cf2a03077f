#include "firmware/machine/accessories.hpp"

#include <optional>
#include <variant>

#include "CppUTest/TestHarness.h"

using namespace cusp::machine;
using cusp::gcode::SpindleMode;

namespace {

constexpr cusp::AxisMask kAllAxes{7};

}  // namespace

TEST_GROUP(SpindleOutput)
{
    Settings settings;
    Accessories accessories;
    void setup() override
    {
        CHECK(!settings.put(30, 10000));
        CHECK(!settings.put(31, 2000));
        accessories.spindle = SpindleMode::kCounterClockwise;
    }
    unsigned pwm(float speed, unsigned percent = 100)
    {
        accessories.speed = speed;
        return output_levels(accessories, percent, kAllAxes, settings).spindle_pwm;
    }
};

TEST(SpindleOutput, RisesFromTheLeastToTheGreatestSpeed)
{
    UNSIGNED_LONGS_EQUAL(0, pwm(0));
    UNSIGNED_LONGS_EQUAL(1, pwm(100));
    UNSIGNED_LONGS_EQUAL(1, pwm(2000));
    UNSIGNED_LONGS_EQUAL(25000, pwm(6000));
    UNSIGNED_LONGS_EQUAL(50000, pwm(10000));
    UNSIGNED_LONGS_EQUAL(50000, pwm(99999));
}

TEST(SpindleOutput, FollowsTheOverrideWithinItsSpeeds)
{
    UNSIGNED_LONGS_EQUAL(25000, pwm(5000, 120));
    UNSIGNED_LONGS_EQUAL(50000, pwm(9000, 200));
    UNSIGNED_LONGS_EQUAL(1, pwm(3000, 10));
}

TEST(SpindleOutput, IsOffWhilePausedAndWhenOff)
{
    accessories.spindle_paused = true;
    UNSIGNED_LONGS_EQUAL(0, pwm(6000));
    CHECK_FALSE(output_levels(accessories, 100, kAllAxes, settings).spindle_on);
    accessories = Accessories{};
    UNSIGNED_LONGS_EQUAL(0, pwm(6000));
}

// The pulses of a motor's controller that is off at 5 %, turns from 10 % on and is at full speed at 90 %.
TEST(SpindleOutput, LiesBetweenTheLeastAndTheGreatestDutyWhileItIsOn)
{
    CHECK(!settings.put(34, 5));
    CHECK(!settings.put(35, 10));
    CHECK(!settings.put(36, 90));
    UNSIGNED_LONGS_EQUAL(2500, pwm(0));
    UNSIGNED_LONGS_EQUAL(5000, pwm(1));
    UNSIGNED_LONGS_EQUAL(5000, pwm(2000));
    UNSIGNED_LONGS_EQUAL(25000, pwm(6000));
    UNSIGNED_LONGS_EQUAL(35000, pwm(8000));
    UNSIGNED_LONGS_EQUAL(45000, pwm(20000));
    accessories.spindle = SpindleMode::kOff;
    UNSIGNED_LONGS_EQUAL(2500, pwm(6000));
    UNSIGNED_LONGS_EQUAL(2500, output_levels(accessories, 100, kAllAxes, settings).spindle_off_pwm);
}

TEST(SpindleOutput, IsConstantWhereTheSettingsLeaveNoRange)
{
    CHECK(!settings.put(35, 60));
    CHECK(!settings.put(36, 40));
    UNSIGNED_LONGS_EQUAL(30000, pwm(2000));
    UNSIGNED_LONGS_EQUAL(30000, pwm(9000));
    CHECK(!settings.put(31, 10000));
    UNSIGNED_LONGS_EQUAL(30000, pwm(9000));
}

TEST(SpindleOutput, HasTheRateOfItsSetting)
{
    UNSIGNED_LONGS_EQUAL(1000, output_levels(accessories, 100, kAllAxes, settings).spindle_hz);
    CHECK(!settings.put(33, 20000));
    UNSIGNED_LONGS_EQUAL(20000, output_levels(accessories, 100, kAllAxes, settings).spindle_hz);
    CHECK(settings.put(33, 0) && settings.put(33, 100001) && settings.put(36, 100.5F));
}

TEST(SpindleOutput, TellsTheBoardWhichLinesToInvert)
{
    CHECK(!settings.put(2, 1));
    CHECK(!settings.put(3, 6));
    CHECK(!settings.put(4, 1));
    const cusp::OutputLevels levels = output_levels(accessories, 100, {}, settings);
    UNSIGNED_LONGS_EQUAL(0x31, levels.inverted_lines);
    CHECK(levels.drives_enable_inverted);
    UNSIGNED_LONGS_EQUAL(0, levels.drives_on);
}
