// The effects of realtime bytes, as the machine's state and `$G` report them.
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;
using machine::State;

namespace {

machine::Settings homing_mill()
{
    machine::Settings settings;
    CHECK(!settings.put(22, 1));
    CHECK(!settings.put(25, 1500));
    CHECK(!settings.put(26, 100));
    return settings;
}

}  // namespace

TEST_GROUP(Operator)
{
    ControllerBench bench;

    void setup() override { bench.run(5); }
    std::string say(const std::string& text)
    {
        bench.board.byte_link.send(text);
        return bench.finish();
    }
    State state() const { return bench.app.machine().state(); }
};

// A hold at each tenth of a second of homing, a cycle start a second after it: the same place.
TEST(Operator, HoldsHomingAndLetsItGoOn)
{
    ControllerBench free{{}, homing_mill()};
    free.board.byte_link.send("$H\n");
    const std::string homed = free.finish();
    CHECK(has_text(homed, "ok"));
    for (unsigned at = 1; at < 8000; at += 97) {
        ControllerBench held{{}, homing_mill()};
        held.board.byte_link.send("$H\n");
        held.run(at);
        if (held.app.machine().idle()) {
            break;
        }
        (void)held.exchange("!", 300);
        CHECK(held.app.machine().state() == State::kHold);
        const auto before = held.board.mill.steps_taken();
        CHECK(has_text(held.exchange("?", 1000), "<Hold:0"));
        CHECK(before[0] == held.board.mill.steps_taken()[0]);
        CHECK(before[1] == held.board.mill.steps_taken()[1]);
        CHECK(before[2] == held.board.mill.steps_taken()[2]);
        held.board.byte_link.send("~");
        held.run(10);
        CHECK(held.app.machine().state() == State::kHome || held.app.machine().idle());
        const std::string answer = held.finish();
        CHECK_TEXT(has_text(answer, "ok"), answer.c_str());
        const Vec3d place = held.position();
        const Vec3d expected = free.position();
        DOUBLES_EQUAL(expected.x, place.x, 1e-6);
        DOUBLES_EQUAL(expected.y, place.y, 1e-6);
        DOUBLES_EQUAL(expected.z, place.z, 1e-6);
        // Positions of the slides, as near as the slow search is fine.
        DOUBLES_EQUAL(free.board.mill.place().z, held.board.mill.place().z, 0.003);
    }
}

TEST(Operator, EndsHeldHomingByResetAndDoor)
{
    for (const char* end : {"\x18", "\x84"}) {
        ControllerBench held{{}, homing_mill()};
        held.board.byte_link.send("$H\n");
        held.run(700);
        (void)held.exchange("!", 400);
        const std::string said = held.exchange(end, 20);
        CHECK_TEXT(has_text(said, end[0] == '\x18' ? "ALARM:6" : "ALARM:7"), said.c_str());
        CHECK(held.app.machine().state() == State::kAlarm);
    }
}

TEST(Operator, TogglesCoolantAsIfTheProgramHad)
{
    CHECK(has_text(say("\xA0$G\n"), " M8 "));
    CHECK(bench.board.mill.outputs().flood);
    CHECK(has_text(say("M7\n$G\n"), " M7 M8 "));  // flood stays on
    CHECK(bench.board.mill.outputs().flood && bench.board.mill.outputs().mist);
    CHECK(has_text(say("\xA1$G\n"), " M8 "));
    CHECK(!bench.board.mill.outputs().mist);
    (void)say("M8\n");
    CHECK(!bench.board.mill.outputs().mist);
    (void)say("M9\n");
    CHECK(has_text(say("\xA0\xA1$G\n"), " M7 M8 "));
    CHECK(bench.board.mill.outputs().flood && bench.board.mill.outputs().mist);
}

// M7 waits for the motion before it: what is toggled meanwhile stays.
TEST(Operator, TogglesCoolantBeforeALineThatWaits)
{
    bench.board.byte_link.send("G1 X5 F600\nM7\n");
    bench.run(100);
    (void)say("\xA0");
    bench.run(1);  // the tick drives the outputs
    CHECK(bench.board.mill.outputs().flood && bench.board.mill.outputs().mist);
    CHECK(has_text(say("$G\n"), " M7 M8 "));
}

TEST(Operator, TogglesCoolantInAJogAndNotInAnAlarm)
{
    bench.board.byte_link.send("$J=G91 X5 F600\n");
    bench.run(100);
    CHECK(state() == State::kJog);
    (void)bench.exchange("\xA0");
    CHECK(bench.board.mill.outputs().flood);
    (void)bench.exchange("\x18");
    CHECK(state() == State::kAlarm);
    (void)bench.exchange("\xA0\xA1");
    CHECK(!bench.board.mill.outputs().flood && !bench.board.mill.outputs().mist);
}

TEST(Operator, StopsAtM1WhereTheSettingSaysSo)
{
    (void)say("M1\nG0 X1\n");
    DOUBLES_EQUAL(1, bench.position().x, 1e-6);
    (void)say("$795=1\n");
    bench.board.byte_link.send("M1\nG0 X2\n");
    bench.run(2000);
    CHECK(state() == State::kHold);
    DOUBLES_EQUAL(1, bench.position().x, 1e-6);
    (void)say("~");
    DOUBLES_EQUAL(2, bench.position().x, 1e-6);
}

TEST(Operator, FindsAllOffAsleepAndAfterIt)
{
    (void)say("M3 S1000\nM7\nM8\n");
    (void)say("$SLP\n");
    std::string said;
    for (unsigned i = 0; i < 4; ++i) {
        said += bench.exchange("?", 5);
    }
    CHECK(has_text(said, "<Sleep"));
    CHECK_FALSE(has_text(said, "|A:"));
    CHECK(has_text(said, "|FS:0,0"));
    CHECK(!bench.board.mill.outputs().spindle_on && !bench.board.mill.outputs().flood);
    (void)bench.exchange("\x18");
    CHECK(has_text(say("$X\n$G\n"), " M5 M9 "));
    (void)say("S2000\n");
    CHECK(!bench.board.mill.outputs().spindle_on);
}
