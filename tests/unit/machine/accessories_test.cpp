#include "firmware/machine/accessories.hpp"

#include <optional>
#include <variant>

#include "CppUTest/TestHarness.h"

using namespace cusp::machine;
using cusp::gcode::SpindleMode;

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
        return output_levels(accessories, percent, true, settings).spindle_pwm;
    }
};

TEST(SpindleOutput, RisesFromTheLeastToTheGreatestSpeed)
{
    UNSIGNED_LONGS_EQUAL(0, pwm(0));
    UNSIGNED_LONGS_EQUAL(1, pwm(100));
    UNSIGNED_LONGS_EQUAL(1, pwm(2000));
    UNSIGNED_LONGS_EQUAL(500, pwm(6000));
    UNSIGNED_LONGS_EQUAL(1000, pwm(10000));
    UNSIGNED_LONGS_EQUAL(1000, pwm(99999));
}

TEST(SpindleOutput, FollowsTheOverrideWithinItsSpeeds)
{
    UNSIGNED_LONGS_EQUAL(500, pwm(5000, 120));
    UNSIGNED_LONGS_EQUAL(1000, pwm(9000, 200));
    UNSIGNED_LONGS_EQUAL(1, pwm(3000, 10));
}

TEST(SpindleOutput, IsOffWhilePausedAndWhenOff)
{
    accessories.spindle_paused = true;
    UNSIGNED_LONGS_EQUAL(0, pwm(6000));
    CHECK_FALSE(output_levels(accessories, 100, true, settings).spindle_on);
    accessories = Accessories{};
    UNSIGNED_LONGS_EQUAL(0, pwm(6000));
}

TEST(SpindleOutput, TellsTheBoardWhichLinesToInvert)
{
    CHECK(!settings.put(2, 1));
    CHECK(!settings.put(3, 6));
    CHECK(!settings.put(4, 1));
    const cusp::OutputLevels levels = output_levels(accessories, 100, false, settings);
    UNSIGNED_LONGS_EQUAL(0x31, levels.inverted_lines);
    CHECK(levels.drives_enabled_inverted);
    CHECK_FALSE(levels.drives_enabled);
}
