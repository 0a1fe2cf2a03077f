// Ends of the rotary axis A: its switch, homing, soft limits, play, and the drive that $37 keeps on.
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;

namespace {

constexpr double kStep = 0.01;  // degrees

hal::MillGeometry with_table()
{
    hal::MillGeometry geometry;
    geometry.start = {-20, -20, -20};
    geometry.rotary = hal::MillGeometry::RotaryTable{1 / kStep, -30.0};
    return geometry;
}

machine::Settings with_switch()
{
    machine::Settings settings;
    CHECK(!settings.put(793, 4) && !settings.put(794, 1) && !settings.put(103, 100));
    CHECK(!settings.put(22, 1) && !settings.put(24, 200) && !settings.put(25, 3000));
    CHECK(!settings.put(26, 5) && !settings.put(46, 8));
    return settings;
}

}  // namespace

TEST_GROUP(RotaryHoming)
{
    ControllerBench bench{with_table(), with_switch()};

    void setup() override { bench.exchange("$X\n"); }
    std::string send(const std::string& line)
    {
        std::string answers = bench.exchange(line + "\n");
        return answers + bench.finish();
    }
    void expect(const std::string& line, const std::string& text)
    {
        const std::string answers = send(line);
        CHECK_TEXT(has_text(answers, text), (line + ": " + answers).c_str());
    }
    double angle() const { return bench.board.mill.angle(); }
};

TEST(RotaryHoming, FindsTheSwitchFromBelow)
{
    expect("$HA", "ok");
    DOUBLES_EQUAL(-1, bench.turned(), 1e-9);
    DOUBLES_EQUAL(-1, angle(), 2 * kStep);
    DOUBLES_EQUAL(0, bench.position().x, 1e-9);
}

TEST(RotaryHoming, FindsItTowardsMinusWithAPullOffOfItsOwn)
{
    send("$23=8");
    send("$853=4");
    expect("$HA", "ok");
    DOUBLES_EQUAL(4, bench.turned(), 1e-9);
    DOUBLES_EQUAL(-346, angle(),
                  2 * kStep);  // it came round to the flag's other end, at 10 degrees
}

TEST(RotaryHoming, IsOneOfThePassesOfAll)
{
    expect("$H", "ok");
    DOUBLES_EQUAL(-1, bench.turned(), 1e-9);
    DOUBLES_EQUAL(-1, bench.position().x, 1e-9);
    DOUBLES_EQUAL(-1, bench.position().z, 1e-9);
}

TEST(RotaryHoming, NeedsASwitch)
{
    send("$794=0");
    expect("$HA", "error:5");
    expect("$H", "ok");
    DOUBLES_EQUAL(-30, angle(), 1e-9);
    send("$793=0");
    expect("$HA", "error:5");
}

TEST(RotaryHoming, FailsWithinOneAndAHalfTurns)
{
    bench.board.mill.force_low(kFourthLimit);
    expect("$HA", "ALARM:9");
    CHECK(angle() < 511);
}

TEST(RotaryHoming, KeepsWithinItsSoftLimitsIfItHasEnds)
{
    expect("$HA", "ok");
    send("$20=1");
    expect("G90 G1 F3000 A400", "ok");  // for ever
    DOUBLES_EQUAL(400, bench.turned(), 1e-9);
    send("G1 A-10");
    send("$133=90");
    expect("$HA", "ok");
    expect("G1 A-89", "ok");
    expect("$J=G90 A-91 F600", "error:15");
    expect("G1 A-91", "ALARM:2");
}

TEST(RotaryHoming, ReportsAndGuardsItsSwitch)
{
    expect("$HA", "ok");
    send("$21=1");
    bench.exchange("G1 F600 A5\n", 500);
    const std::string report = bench.exchange("?");
    CHECK_TEXT(has_text(report, "ALARM:1") || has_text(report, "Alarm"), report.c_str());
    CHECK_TEXT(has_text(report, "|Pn:A"), report.c_str());
}

TEST(RotaryHoming, TakesUpItsPlay)
{
    send("$163=0.5");
    send("G0 A2");
    const std::int64_t up = bench.board.mill.steps()[3];
    send("G0 A0");
    LONGS_EQUAL(250, up - bench.board.mill.steps()[3]);
    DOUBLES_EQUAL(0, bench.turned(), 1e-9);
}

TEST(RotaryHoming, KeepsItsDriveOnAlone)
{
    constexpr unsigned kFourth = 8;
    send("$37=8");
    send("G0 A2");
    bench.run(500);
    LONGS_EQUAL(kFourth, bench.board.mill.outputs().drives_on);
    send("$37=7");
    bench.run(500);
    LONGS_EQUAL(7, bench.board.mill.outputs().drives_on);
}
