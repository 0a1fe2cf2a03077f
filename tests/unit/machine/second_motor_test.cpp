// An axis with two motors: they step alike, and homing squares them on two switches.
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"
#include "tests/support/property_cases.hpp"

using namespace cusp;
using machine::State;

namespace {

constexpr double kStep = 1.0 / 800;
// The position of a contact is accurate to the travel of a servo tick and a step of each motor.
constexpr double kSlow = 120;  // mm/min
constexpr double kAccuracy = kSlow / 60 / 1000 + 2 * kStep;

struct Gantry {
    unsigned axis{1};
    double ahead{0};        // of the second motor, mm
    double switch_more{0};  // of the second motor's switch, mm
    bool has_switch{true};
};

class Bench : public ControllerBench {
public:
    explicit Bench(const Gantry& gantry, bool squares = true)
        : ControllerBench{geometry(gantry), settings(gantry, squares)}, gantry_{gantry}
    {
        (void)exchange("$X\n");
    }
    static hal::MillGeometry geometry(const Gantry& gantry)
    {
        hal::MillGeometry geometry;
        geometry.start = {-20, -20, -10};
        geometry.second_motor = gantry.axis;
        geometry.second_ahead = gantry.ahead;
        geometry.second_switch =
            gantry.has_switch ? std::optional<double>{gantry.switch_more} : std::nullopt;
        return geometry;
    }
    static machine::Settings settings(const Gantry& gantry, bool squares)
    {
        machine::Settings settings;
        CHECK(!settings.put(22, 1));
        CHECK(!settings.put(24, static_cast<float>(kSlow)));
        CHECK(!settings.put(25, 3000));
        CHECK(!settings.put(26, 5));
        CHECK(!settings.put(793, static_cast<float>(gantry.axis + 1)));
        CHECK(!settings.put(794, squares ? 1 : 0));
        return settings;
    }
    std::string say(const std::string& text)
    {
        board.byte_link.send(text);
        return finish();
    }
    double first() const { return board.mill.place()[gantry_.axis]; }
    double second() const { return board.mill.second_place(); }
    // Distance of the second motor beyond its switch, less that of the first.
    double skew() const { return second() - gantry_.switch_more - first(); }

private:
    Gantry gantry_;
};

double uniform(std::mt19937& random, double least, double most)
{
    return std::uniform_real_distribution<double>{least, most}(random);
}

}  // namespace

TEST_GROUP(SecondMotor){};

TEST(SecondMotor, MakesNoStepsUnlessASettingNamesItsAxis)
{
    ControllerBench bench;
    (void)bench.exchange("G91G1X3Y2Z-1F3000\n", 3000);
    DOUBLES_EQUAL(bench.board.mill.place().x, -47, kStep);
    LONGS_EQUAL(0, bench.board.pulse_player.levels() & (kSecondStepLine | kSecondDirectionLine));
    DOUBLES_EQUAL(-50, bench.board.mill.second_place(), 0);
}

TEST(SecondMotor, StepsWithItsAxisInNormalMotion)
{
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        Bench bench{{axis, 0.5, 0}};
        std::string said = bench.say("G91G1X3Y2Z-1F3000\nX-5Y-7Z3\nG2X1Y1I1\nG0X2Y1Z-3\n");
        CHECK_FALSE(has_text(said, "error"));
        DOUBLES_EQUAL(0.5, bench.second() - bench.first(), 1e-9);
        CHECK(std::fabs(bench.first() - Bench::geometry({axis, 0, 0}).start[axis]) > 1e-9);
    }
}

// Set after the axis has reversed: the new line must have the same direction.
TEST(SecondMotor, TurnsWithItsAxisFromTheFirstMoveOn)
{
    for (const char* first : {"G91G1Y1F3000\n", "G91G1Y-1F3000\n"}) {
        for (const char* then : {"Y2\n", "Y-2\n"}) {
            Bench bench{{1, 0, 0}};
            (void)bench.say("$793=0\n");
            (void)bench.say(first);
            const double before = bench.second() - bench.first();
            (void)bench.say(std::string{"$793=2\n"} + then);
            DOUBLES_EQUAL(before, bench.second() - bench.first(), 1e-9);
        }
    }
}

TEST(SecondMotor, IsSquaredByHoming)
{
    constexpr unsigned kSeed = 24;
    std::printf("(seed %u) ", kSeed);
    std::mt19937 random{kSeed};
    for (int i = 0; i < test::property_cases(40); ++i) {
        const Gantry gantry{static_cast<unsigned>(random() % 2), uniform(random, -4, 4),
                            uniform(random, -3, 3)};
        Bench bench{gantry};
        const bool to_minus = random() % 2 == 0;
        if (to_minus) {
            (void)bench.say("$23=7\n");
        }
        const bool fast = random() % 3 == 0;
        if (fast) {
            (void)bench.say("$24=600\n");
        }
        const std::string said = bench.say("$H\n");
        CHECK_FALSE(has_text(said, "ALARM"));
        const double accuracy = fast ? 600 / kSlow * kAccuracy : kAccuracy;
        DOUBLES_EQUAL(0, bench.skew(), accuracy);
        const double travel = Bench::geometry(gantry).travel[gantry.axis];
        const double wanted = to_minus ? 1 - travel : -1;
        // The axis is at the switch that closed first.
        const double off = bench.first() - wanted;
        DOUBLES_EQUAL(0, off, accuracy);
        // It stays square.
        (void)bench.say("G53G0X-50Y-50\n");
        DOUBLES_EQUAL(0, bench.skew(), accuracy);
    }
}

TEST(SecondMotor, IsAsFarFromSquareAsTheOffset)
{
    for (const double offset : {0.25, -0.25}) {
        for (const double ahead : {1.5, -1.5}) {
            Bench bench{{1, ahead, 0}};
            CHECK(has_text(bench.say("$171=" + std::to_string(offset) + "\n"), "ok"));
            CHECK_FALSE(has_text(bench.say("$H\n"), "ALARM"));
            DOUBLES_EQUAL(offset, bench.skew(), kAccuracy);
        }
    }
}

TEST(SecondMotor, GoesAlongWhereItHasNoSwitch)
{
    Bench bench{{1, 0.75, 0, false}, false};
    CHECK_FALSE(has_text(bench.say("$H\n"), "ALARM"));
    DOUBLES_EQUAL(0.75, bench.second() - bench.first(), 1e-9);
    DOUBLES_EQUAL(-1, bench.first(), kAccuracy);
}

TEST(SecondMotor, EndsInAlarm15WhereASwitchNeverCloses)
{
    Bench bench{{1, 0, 0, false}};
    const std::string said = bench.say("$H\n");
    CHECK(has_text(said, "ALARM:15"));
    CHECK(bench.app.machine().state() == State::kAlarm);
    // 5 % of 200 mm, plus the braking distance.
    const double alone = bench.second() - bench.first();
    DOUBLES_EQUAL(10, alone, 0.1);
    const double stopped_at = bench.second();
    bench.run(500);
    DOUBLES_EQUAL(stopped_at, bench.second(), 0);
    CHECK(has_text(bench.say("$X\nG91G1X1F1000\n"), "Unlocked"));
}

TEST(SecondMotor, EndsInAlarm15WhereTheSkewIsOverTheLimit)
{
    for (const double ahead : {2.9, -2.9}) {
        Bench bench{{1, ahead, 0}};
        CHECK(has_text(bench.say("$347=1\n$348=3\n"), "ok"));
        CHECK_FALSE(has_text(bench.say("$H\n"), "ALARM"));
    }
    for (const double ahead : {3.1, -3.1}) {
        Bench bench{{1, ahead, 0}};
        (void)bench.say("$347=1\n$348=3\n");
        CHECK(has_text(bench.say("$H\n"), "ALARM:15"));
    }
    for (const double ahead : {3.1, -3.1}) {
        Bench bench{{1, ahead, 0}};
        (void)bench.say("$349=3\n");
        CHECK(has_text(bench.say("$H\n"), "ALARM:15"));
    }
}

TEST(SecondMotor, StepsWithTheFirstAgainAfterAResetAmidSquaring)
{
    Bench bench{{1, -6, 0}};
    bench.board.byte_link.send("$HY\n");
    const double apart = bench.second() - bench.first();
    for (unsigned i = 0; i < 100000 && std::fabs(bench.second() - bench.first() - apart) < 1; ++i) {
        bench.run(1);
    }
    CHECK(std::fabs(bench.second() - bench.first() - apart) >= 1);
    CHECK(has_text(bench.exchange("\x18", 200), "ALARM:6"));
    const double stopped = bench.second() - bench.first();
    (void)bench.say("$X\n");
    (void)bench.say("G91G1Y-5F3000\n");
    DOUBLES_EQUAL(stopped, bench.second() - bench.first(), 1e-9);
}

TEST(SecondMotor, HasASwitchThatGuardsTheTravelToo)
{
    Bench bench{{1, 5, 0}};
    (void)bench.say("$21=1\n");
    const std::string said = bench.say("G91G1Y18F3000\n");
    CHECK(has_text(said, "ALARM:1"));
    CHECK(bench.first() < -1);
    bench.board.byte_link.send("\x18");
    bench.run(50);
    CHECK(has_text(bench.exchange("?"), "|Pn:Y"));
}

// An input without a switch may have any level.
TEST(SecondMotor, HasASwitchThatIsReadWithSquaringAlone)
{
    for (const char* setting : {"$794=0\n", "$793=0\n"}) {
        Bench bench{{1, 0, 0}};
        bench.board.mill.force_high(kFourthLimit);
        (void)bench.say(setting);
        (void)bench.say("$21=1\n");
        CHECK_FALSE(has_text(bench.say("G91G1Y1F3000\n"), "ALARM"));
        CHECK_FALSE(has_text(bench.exchange("?"), "Pn:"));
    }
}

TEST(SecondMotor, IsRefusedByABoardWithoutPinsForIt)
{
    machine::Settings settings;
    CHECK(!settings.put(793, 2));
    CHECK_FALSE(settings.find_fault().has_value());
    const auto fault = settings.find_fault({1000000, false});
    CHECK(fault.has_value());
    LONGS_EQUAL(793, fault->first);
    CHECK_FALSE(settings.sound({1000000, false}));
}

TEST(SecondMotor, IsInvertedWithItsAxisAndTurnedRoundByASettingOfItsOwn)
{
    const auto inverted = [](float steps, float directions, float second) {
        machine::Settings settings;
        CHECK(!settings.put(793, 2));
        CHECK(!settings.put(2, steps));
        CHECK(!settings.put(3, directions));
        CHECK(!settings.put(8, second));
        return machine::output_levels({}, 100, {}, settings).inverted_lines;
    };
    UNSIGNED_LONGS_EQUAL(0, inverted(0, 0, 5));
    UNSIGNED_LONGS_EQUAL(0x42, inverted(2, 0, 0));
    UNSIGNED_LONGS_EQUAL(0x90, inverted(0, 2, 0));
    UNSIGNED_LONGS_EQUAL(0x80, inverted(0, 0, 2));
    UNSIGNED_LONGS_EQUAL(0x10, inverted(0, 2, 2));
}

TEST(SecondMotor, HasAnOffsetThatMayBeNegative)
{
    Bench bench{{1, 0, 0}};
    CHECK(has_text(bench.say("$171=-0.25\n"), "ok"));
    CHECK(has_text(bench.say("$$\n"), "$171=-0.250\r\n"));
    CHECK(has_text(bench.say("$171=-10.5\n"), "error:"));
    CHECK(has_text(bench.say("$100=-1\n"), "error:4"));
}
