// Nothing moves before the spindle is up: after M3 and M4, behind a hold, behind the door, behind a
// tool change.
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;
using machine::State;

namespace {

constexpr const char* kStopSpindle = "\x9E";
constexpr unsigned kGrblsTicks = 4000;
constexpr unsigned kAllowedTicks = 60;  // of the first steps after the delay

class SpindleMill {
public:
    explicit SpindleMill(float delay_s = 0) : bench{{}, settings(delay_s)} { bench.run(5); }

    static machine::Settings settings(float delay_s)
    {
        machine::Settings settings;
        CHECK(!settings.put(394, delay_s));
        return settings;
    }
    // Ticks from the bytes to the next step.
    unsigned ticks_to_motion(const std::string& bytes)
    {
        const std::uint64_t before = steps();
        bench.board.byte_link.send(bytes);
        unsigned ticks = 0;
        while (steps() == before && ticks < 100000) {
            bench.run(1);
            ++ticks;
        }
        return ticks;
    }
    void hold_amid(const std::string& line)
    {
        bench.board.byte_link.send(line);
        bench.run(15000);
        (void)bench.exchange("!", 1000);
        CHECK(state() == State::kHold);
    }
    State state() const { return bench.app.machine().state(); }
    bool spindle_on() const { return bench.board.mill.outputs().spindle_on; }
    std::uint64_t steps() const { return bench.board.mill.steps_taken()[0]; }

    ControllerBench bench;
};

void is_about(unsigned expected, unsigned ticks, const char* what)
{
    CHECK_TEXT(ticks >= expected && ticks <= expected + kAllowedTicks, what);
}

}  // namespace

TEST_GROUP(SpindleStart){};

TEST(SpindleStart, DelaysMotionAfterM3AndM4AndNothingElse)
{
    struct Case {
        const char* before;
        const char* lines;
        bool delayed;
    };
    constexpr Case kCases[] = {
        {"", "M3 S1000\nG0 X1\n", true},
        {"", "G0 X1 M4 S1000\n", true},
        {"", "M3 S1000\n$J=G91 X1 F1000\n", true},
        {"M3 S1000\n", "G0 X1\n", false},
        {"M3 S1000\n", "M3 S2000\nG0 X1\n", false},  // another speed
        {"M3 S1000\n", "S500 G0 X1\n", false},
        {"M3 S0\n", "S500 G0 X1\n", true},    // it was at rest
        {"M3 S1000\n", "M4\nG0 X1\n", true},  // the other way round
        {"M3 S1000\nM5\n", "M3\nG0 X1\n", true},
        {"", "M5\nG0 X1\n", false},
        {"", "S1000\nG0 X1\n", false},
        {"", "M8\nG0 X1\n", false},
    };
    for (const Case& given : kCases) {
        SpindleMill mill{1.5F};
        mill.bench.board.byte_link.send(given.before);
        (void)mill.bench.finish();
        is_about(given.delayed ? 1500 : 0, mill.ticks_to_motion(given.lines), given.lines);
    }
}

TEST(SpindleStart, DoesNotDelayUnlessTheSettingSaysSo)
{
    SpindleMill mill;
    is_about(0, mill.ticks_to_motion("M3 S1000\nG0 X1\n"), "after M3");
}

TEST(SpindleStart, DelaysTheEndOfAHoldThatStoppedIt)
{
    for (const float delay : {0.0F, 0.5F, 6.0F}) {
        const unsigned expected = delay > 0 ? static_cast<unsigned>(delay * 1000) : kGrblsTicks;
        SpindleMill mill{delay};
        mill.hold_amid("M3 S1000\nG1 X200 F500\n");
        (void)mill.bench.exchange(kStopSpindle, 50);
        CHECK(!mill.spindle_on());
        is_about(expected, mill.ticks_to_motion("~"), "stopped in a hold");
        CHECK(mill.spindle_on());
        // Left on, it is up.
        (void)mill.bench.exchange("!", 1000);
        is_about(0, mill.ticks_to_motion("~"), "left on");
        // Switched on again by hand, the rest of its time.
        (void)mill.bench.exchange("!", 1000);
        (void)mill.bench.exchange(kStopSpindle, 50);
        (void)mill.bench.exchange(kStopSpindle, 300);
        is_about(expected - 300, mill.ticks_to_motion("~"), "on again in the hold");
    }
}

TEST(SpindleStart, DelaysMotionBehindADoor)
{
    for (const float delay : {0.0F, 0.5F, 6.0F}) {
        SpindleMill mill{delay};
        mill.bench.board.byte_link.send("M3 S1000\nG1 X200 F500\n");
        mill.bench.run(12000);
        (void)mill.bench.exchange("\x84", 1000);
        CHECK(!mill.spindle_on());
        is_about(delay > 0 ? static_cast<unsigned>(delay * 1000) : kGrblsTicks,
                 mill.ticks_to_motion("~"), "behind a door");
    }
}

TEST(SpindleStart, IsCalledOffByAFeedHold)
{
    for (const bool by_door : {true, false}) {
        SpindleMill mill{1};
        mill.hold_amid("M3 S1000\nG1 X200 F500\n");
        (void)mill.bench.exchange(by_door ? "\x84" : kStopSpindle, 50);
        (void)mill.bench.exchange("~", 500);
        CHECK(mill.spindle_on());
        const std::uint64_t before = mill.steps();
        (void)mill.bench.exchange("!", 5000);
        CHECK(mill.state() == State::kHold);
        CHECK(mill.steps() == before);
        CHECK(mill.spindle_on());
        is_about(0, mill.ticks_to_motion("~"), "up by then");
    }
}

TEST(SpindleStart, IsCalledOffByTheSpindleStop)
{
    SpindleMill mill{1};
    mill.hold_amid("M3 S1000\nG1 X200 F500\n");
    (void)mill.bench.exchange(kStopSpindle, 50);
    (void)mill.bench.exchange("~", 500);
    const std::uint64_t before = mill.steps();
    (void)mill.bench.exchange(kStopSpindle, 3000);
    CHECK(!mill.spindle_on() && mill.steps() == before && mill.state() == State::kHold);
    is_about(1000, mill.ticks_to_motion("~"), "from the start again");
}

TEST(SpindleStart, AfterM3IsHeldAndGoesOnOnceItIsUp)
{
    SpindleMill mill{2};
    mill.bench.board.byte_link.send("M3 S1000\nG1 X200 F500\n");
    mill.bench.run(500);
    (void)mill.bench.exchange("!", 100);
    CHECK(mill.state() == State::kHold);
    (void)mill.bench.exchange(kStopSpindle, 5000);
    CHECK(mill.steps() == 0 && !mill.spindle_on());
    is_about(2000, mill.ticks_to_motion("~"), "after M3, a hold and a stop");
}

// $797: the spindle's drive says when it is up; its contact is open (high) until then.
TEST(SpindleStart, WaitsForTheSpindleThatSaysWhenItIsUp)
{
    for (const float delay : {0.0F, 2.0F}) {
        SpindleMill mill{delay};
        (void)mill.bench.exchange("$797=1\n", 50);
        mill.bench.board.mill.force_high(kAtSpeed);
        mill.bench.board.byte_link.send("M3 S1000\nG0 X1\n");
        mill.bench.run(1200);
        CHECK(mill.spindle_on() && mill.steps() == 0);
        mill.bench.board.mill.force_high(0);
        is_about(0, mill.ticks_to_motion(""), "at speed");
        // Another speed of a spindle that turns needs no wait.
        mill.bench.board.mill.force_high(kAtSpeed);
        (void)mill.bench.finish();
        is_about(0, mill.ticks_to_motion("S2000 G0 X2\n"), "another speed");
        // Turned about it is not at speed, though its drive says so for some ticks yet.
        mill.bench.board.mill.force_high(0);
        (void)mill.bench.finish();
        mill.bench.board.byte_link.send("M4 G0 X1\n");
        const std::uint64_t before = mill.steps();
        mill.bench.run(20);
        mill.bench.board.mill.force_high(kAtSpeed);
        mill.bench.run(500);
        CHECK(mill.steps() == before);
    }
}

TEST(SpindleStart, RaisesAnAlarmIfTheSpindleDoesNotComeUpInTime)
{
    for (const float delay : {0.0F, 1.5F}) {
        const unsigned longest = delay > 0 ? 1500 : kGrblsTicks;
        SpindleMill mill{delay};
        (void)mill.bench.exchange("$797=1\n", 50);
        mill.bench.board.mill.force_high(kAtSpeed);
        mill.bench.board.byte_link.send("M3 S1000\nG0 X1\n");
        mill.bench.run(longest - 10);
        CHECK(mill.spindle_on() && mill.state() != State::kAlarm);
        const std::string said = mill.bench.exchange("", 60);
        CHECK_TEXT(said.find("ALARM:14") != std::string::npos, said.c_str());
        CHECK_TEXT(said.find("error:9") != std::string::npos, said.c_str());
        CHECK(!mill.spindle_on() && mill.state() == State::kAlarm && mill.steps() == 0);
        (void)mill.bench.exchange("$X\n", 50);
        CHECK(mill.state() == State::kIdle);
    }
}

TEST(SpindleStart, DoesNotAskAnInputThatNoSettingNames)
{
    SpindleMill mill;
    mill.bench.board.mill.force_high(kAtSpeed);
    is_about(0, mill.ticks_to_motion("M3 S1000\nG0 X1\n"), "not asked");
}
