// M6 on the simulated mill: away from the part, changed by hand, touched off on a plate, and back.
#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"
#include "tests/support/property_cases.hpp"

using namespace cusp;
using machine::State;

namespace {

constexpr double kPlate = -40.0;  // where the first tool touches, machine mm
// A contact is at a whole step, accurate to the travel of a servo tick at 60 mm/min.
constexpr double kTouchOffAccuracy = 0.003;

machine::Settings settings_with(unsigned mode)
{
    machine::Settings settings;
    CHECK(!settings.put(22, 1));
    CHECK(!settings.put(25, 3000));
    CHECK(!settings.put(26, 1));
    CHECK(!settings.put(341, static_cast<float>(mode)));
    CHECK(!settings.put(342, 35));
    CHECK(!settings.put(343, 60));
    CHECK(!settings.put(344, 600));
    return settings;
}

class Mill {
public:
    explicit Mill(unsigned mode, bool homes = true) : bench{geometry(kPlate), settings_with(mode)}
    {
        (void)bench.exchange("$X\n");
        if (homes) {
            say("$H\n");
        }
        say("G10L2P9X-250Y-150Z-20\nG0X-10Y-20Z-30\n");
    }

    static hal::MillGeometry geometry(double plate)
    {
        hal::MillGeometry geometry;
        geometry.plate_above_start = plate - geometry.start.z;
        return geometry;
    }
    // A tool that touches this much higher than the first.
    void fit_tool(double longer) { bench.board.mill.set_geometry(geometry(kPlate + longer)); }
    void take_plate_away() { bench.board.mill.set_geometry({}); }

    // Sends the line, and waits until it is done.
    std::string say(const std::string& text)
    {
        bench.board.byte_link.send(text);
        return bench.finish();
    }
    // Sends the line, and waits until the machine holds.
    std::string until_held(const std::string& text)
    {
        bench.board.byte_link.send(text);
        for (unsigned i = 0; i < 100000 && !held(); ++i) {
            bench.run(1);
        }
        return bench.board.byte_link.take_answers();
    }
    bool held() const
    {
        const auto& machine = bench.app.machine();
        return machine.state() == State::kHold && machine.motion().at_rest();
    }
    std::string change(unsigned tool, double longer)
    {
        std::string said = until_held("T" + std::to_string(tool) + "M6\n");
        CHECK_TRUE(held());
        fit_tool(longer);
        said += say("~");
        return said;
    }
    void is_at(double x, double y, double z) const
    {
        const Vec3d at = bench.position();
        DOUBLES_EQUAL(x, at.x, 1e-6);
        DOUBLES_EQUAL(y, at.y, 1e-6);
        DOUBLES_EQUAL(z, at.z, kTouchOffAccuracy);
    }
    double offset() const
    {
        return static_cast<double>(bench.app.machine().parameters().tool_length_offset_nm) * 1e-6;
    }
    const OutputLevels& outputs() const { return bench.board.mill.outputs(); }

    ControllerBench bench;
};

unsigned count_of(const std::string& text, const std::string& part)
{
    unsigned found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++found;
    }
    return found;
}

}  // namespace

TEST_GROUP(ToolChange){};

TEST(ToolChange, AtTheTopStopsTheSpindleAndComesBack)
{
    Mill mill{1};
    mill.say("M3S1000\nM8\n");
    CHECK(mill.outputs().spindle_on && mill.outputs().flood);
    const std::string asked = mill.until_held("T7M6\nG4P0\n");
    STRCMP_EQUAL("[MSG:Tool change T7: cycle start to go on]\r\n", asked.c_str());
    mill.is_at(-10, -20, -1);
    CHECK(!mill.outputs().spindle_on && !mill.outputs().flood);
    // Up to speed before it goes down.
    mill.bench.board.byte_link.send("~");
    mill.bench.run(2000);
    mill.is_at(-10, -20, -1);
    CHECK(mill.outputs().spindle_on && mill.outputs().flood);
    STRCMP_EQUAL("ok\r\nok\r\n", mill.say("").c_str());
    mill.is_at(-10, -20, -30);
    DOUBLES_EQUAL(0, mill.offset(), 0);
}

TEST(ToolChange, AtItsPlaceGoesDownThereAndComesBackByTheTop)
{
    Mill mill{2};
    (void)mill.until_held("T2M6\n");
    mill.is_at(-250, -150, -20);
    CHECK(has_text(mill.bench.exchange("?", 1), "<Hold:0|"));
    mill.bench.board.byte_link.send("~");
    double highest = -80;
    while (!mill.bench.app.machine().idle()) {
        mill.bench.run(1);
        highest = std::max(highest, mill.bench.position().z);
    }
    DOUBLES_EQUAL(-1, highest, 1e-6);
    mill.is_at(-10, -20, -30);
}

TEST(ToolChange, TheFirstToolTouchedOffKeepsTheOffsetAndTheNextIsMeasuredAgainstIt)
{
    Mill mill{3};
    CHECK(has_text(mill.change(1, 0), "[MSG:Tool T1: length 0.000]\r\nok"));
    mill.is_at(-10, -20, -30);
    const std::string said = mill.change(2, 5.25);
    CHECK(has_text(said, "[MSG:Tool T2: length 5.2"));
    DOUBLES_EQUAL(5.25, mill.offset(), kTouchOffAccuracy);
    mill.is_at(-10, -20, -30 + mill.offset());
    CHECK(has_text(mill.change(3, -12), "[MSG:Tool T3: length -1"));
    mill.is_at(-10, -20, -42);
    const std::string listed = mill.say("$#\n");
    CHECK(has_text(
        listed,
        "[G92:0.000,0.000,0.000]\r\n[T:1|0.000,0.000,0.000|0.000]\r\n[T:2|0.000,0.000,5.2"));
    CHECK_FALSE(has_text(listed, "[T:4"));
    // In program coordinates the tip never moved, and G43 H uses the measured length.
    (void)mill.say("G43H2\nG1Z-30F1000\n");
    mill.is_at(-10, -20, -24.75);
    CHECK(has_text(mill.say("G43H4\n"), "error:38"));
}

TEST(ToolChange, ATableLengthOfTheFirstToolIsTheReference)
{
    Mill mill{3};
    mill.say("G10L1P4Z20\nG43H4\nG0X-11\n");
    (void)mill.change(4, 1);
    DOUBLES_EQUAL(20, mill.offset(), 1e-6);
    (void)mill.change(5, -2);
    DOUBLES_EQUAL(17, mill.offset(), 2 * kTouchOffAccuracy);
}

TEST(ToolChange, IsRefusedWholeBeforeHoming)
{
    for (unsigned mode = 1; mode <= 3; ++mode) {
        Mill mill{mode, false};
        const Vec3d before = mill.bench.position();
        CHECK(has_text(mill.say("T2M6M3S1000\n"), "error:46"));
        mill.is_at(before.x, before.y, before.z);
        CHECK(!mill.outputs().spindle_on);
        CHECK(has_text(mill.say("$G\n"), " M5 M9 T0 "));
        CHECK(has_text(mill.say("$HX\n$HY\n$HZ\n"), "ok"));
        CHECK(has_text(mill.until_held("T2M6\n"), "Tool change T2"));
    }
}

// At its default G59.3 is machine zero: travelled to, and a touch-off would go down there.
TEST(ToolChange, IsRefusedWholeWhereItsPlaceIsNotSet)
{
    for (unsigned mode = 1; mode <= 3; ++mode) {
        Mill mill{mode};
        mill.say("G10L2P9X0Y0Z0\n");
        if (mode == 1) {  // over the part
            CHECK(has_text(mill.until_held("T2M6\n"), "Tool change T2"));
            continue;
        }
        CHECK(has_text(mill.say("T2M6M3S1000G0X-50\n"), "error:47"));
        mill.is_at(-10, -20, -30);
        CHECK(!mill.outputs().spindle_on);
        CHECK(has_text(mill.say("$G\n"), " M5 M9 T0 "));
        CHECK(has_text(mill.say("$RST=#\n$H\nT2M6\n"), "error:47"));
        CHECK(has_text(mill.say("$C\nT2M6\n$C\n$X\n"), "ok"));
        // Setting one axis counts as setting the place.
        CHECK(has_text(mill.say("G10L2P9Z-20\n"), "ok"));
        CHECK(has_text(mill.until_held("T2M6\n"), "Tool change T2"));
        mill.is_at(0, 0, mode == 2 ? -20 : -1);
    }
}

TEST(ToolChange, NeedsHomingAgainOnceThePositionMayBeLost)
{
    Mill mill{1};
    mill.bench.board.byte_link.send("G1Z-60F600\n");
    mill.bench.run(500);
    (void)mill.bench.exchange("\x18", 100);
    CHECK(has_text(mill.say("$X\nT1M6\n"), "error:46"));
    CHECK(has_text(mill.say("$H\n"), "ok"));
    CHECK(has_text(mill.until_held("T1M6\n"), "Tool change T1"));
}

TEST(ToolChange, ASetterThatIsNotThereIsAnAlarm)
{
    Mill mill{3};
    (void)mill.until_held("T1M6M3S1000\n");
    mill.take_plate_away();
    STRCMP_EQUAL("ALARM:5\r\nerror:9\r\n", mill.say("~").c_str());
    mill.is_at(-250, -150, -55);  // 35 mm below G59.3
    CHECK(!mill.outputs().spindle_on);
    LONGS_EQUAL(static_cast<int>(State::kAlarm),
                static_cast<int>(mill.bench.app.machine().state()));
    DOUBLES_EQUAL(0, mill.offset(), 0);
}

TEST(ToolChange, TheSearchEndsWithTheTravel)
{
    Mill mill{3};
    (void)mill.say("G10L2P9Z-60\n");
    (void)mill.until_held("T1M6\n");
    mill.take_plate_away();
    CHECK(has_text(mill.say("~"), "ALARM:5"));
    mill.is_at(-250, -150, -80);
}

TEST(ToolChange, ASetterThatIsClosedAlreadyIsAnAlarm)
{
    Mill mill{3};
    (void)mill.until_held("T1M6\n");
    mill.bench.board.mill.force_high(kProbe);
    CHECK(has_text(mill.say("~"), "ALARM:4\r\nerror:9"));
    mill.is_at(-250, -150, -20);
}

TEST(ToolChange, APlaceBeyondTheTravelMovesNothing)
{
    Mill mill{3};
    (void)mill.say("G10L2P9X-301\n");
    CHECK(has_text(mill.say("T1M6\n"), "ALARM:2\r\n[MSG:Reset to continue]\r\nerror:15"));
    mill.is_at(-10, -20, -30);
}

TEST(ToolChange, AToolWithWhichTheTipCannotComeBackIsAnAlarm)
{
    Mill mill{3};
    (void)mill.change(1, 0);
    (void)mill.say("G0Z-3\n");
    (void)mill.until_held("T2M6\n");
    mill.fit_tool(5);
    CHECK(has_text(mill.say("~"), "ALARM:2\r\n[MSG:Reset to continue]\r\nerror:15"));
    const double z = mill.bench.position().z;
    CHECK(z < -35 && z > -35.05);  // it brakes behind the contact
}

TEST(ToolChange, AResetAtTheChangeKeepsThePositionAndForgetsLengths)
{
    Mill mill{3};
    (void)mill.change(1, 0);
    (void)mill.change(2, 5);
    (void)mill.until_held("T3M6\n");
    const std::string said = mill.bench.exchange("\x18", 100);
    CHECK(has_text(said, "Grbl 1.1h") && !has_text(said, "ALARM"));
    mill.is_at(-250, -150, -1);
    DOUBLES_EQUAL(0, mill.offset(), 0);
    CHECK(mill.bench.app.machine().parameters().tools.empty());
    CHECK(has_text(mill.say("G0X-10Y-20Z-30\n"), "ok"));
    CHECK(has_text(mill.change(3, -4), "length 0.000"));
}

TEST(ToolChange, WhatG10SaysIsStoredAndWhatWasTouchedOffIsNot)
{
    Mill mill{3};
    (void)mill.change(1, 0);
    (void)mill.change(2, 5);
    (void)mill.say("G10L1P3Z-1.5\nG10L2P2X1\n");
    (void)mill.bench.exchange("\x18", 100);
    const gcode::ToolTable& tools = mill.bench.app.machine().parameters().tools;
    CHECK(tools.has(3) && !tools.has(1) && !tools.has(2));
    LONGS_EQUAL(-1500000, tools.length_nm(3));
    CHECK(has_text(mill.say("$#\n"), "[T:3|0.000,0.000,-1.500|0.000]"));
    (void)mill.bench.exchange("$RST=#\n", 2000);
    CHECK(mill.bench.app.machine().parameters().tools.empty());
}

TEST(ToolChange, IsLeftOutInCheckModeAndWhereM6IsIgnored)
{
    Mill ignored{4};
    STRCMP_EQUAL("ok\r\n", ignored.say("T2M6\n").c_str());
    ignored.is_at(-10, -20, -30);
    Mill checked{3};
    (void)checked.say("$C\n");
    STRCMP_EQUAL("ok\r\n", checked.say("T2M6\n").c_str());
    checked.is_at(-10, -20, -30);
}

TEST(ToolChange, TheDoorMayBeOpenedForIt)
{
    Mill mill{3};
    (void)mill.say("M3S1000\n");
    (void)mill.until_held("T1M6\n");
    mill.bench.board.mill.force_high(kDoor);
    CHECK(has_text(mill.bench.exchange("", 50), "Check Door"));
    (void)mill.bench.exchange("~", 50);
    mill.is_at(-250, -150, -1);
    mill.bench.board.mill.force_high(0);
    (void)mill.bench.exchange("", 50);
    CHECK(has_text(mill.bench.exchange("?", 1), "<Door:0"));
    CHECK(!mill.outputs().spindle_on);
    (void)mill.say("~");
    mill.is_at(-10, -20, -30);
    CHECK(mill.outputs().spindle_on);
}

// A hold amid the contact's own stop, and its end: the tool goes no deeper.
TEST(ToolChange, AHoldAtTheContactDoesNotDriveTheToolOn)
{
    for (unsigned late = 0; late < 12; ++late) {
        Mill mill{0};
        mill.bench.board.byte_link.send("G38.2Z-60F1000\n");
        while (!mill.bench.app.machine().motion().contact()) {
            mill.bench.run(1);
        }
        mill.bench.run(late);
        std::string said = mill.bench.exchange("!", 200);
        mill.bench.board.byte_link.send("~");
        // As on a chip: the servo tick comes between any two slices of the main loop.
        for (unsigned i = 0; i < 100; ++i) {
            (void)mill.bench.app.poll();
            mill.bench.app.tick();
            mill.bench.board.advance();
        }
        said += mill.say("");
        CHECK(has_text(said, "[PRB:") && has_text(said, ":1]"));
        CHECK(mill.bench.position().z > kPlate - 1.0);
    }
}

// With holds at random ticks every tool is measured, and the tip returns.
TEST(ToolChange, RandomToolsAndHoldsLeaveTheProgramWhereItWas)
{
    const auto last = static_cast<unsigned>(test::property_cases(8));
    for (unsigned seed = 1; seed <= last; ++seed) {
        const std::string where = "seed " + std::to_string(seed);
        std::mt19937 random{seed};
        std::uniform_real_distribution<double> longer{-10, 10};
        Mill mill{3};
        (void)mill.change(1, 0);
        std::string said;
        for (unsigned change = 0; change < 4; ++change) {
            const unsigned tool = 2 + static_cast<unsigned>(random() % 15);
            const double length = std::round(longer(random) * 800) / 800;
            said += mill.until_held("T" + std::to_string(tool) + "M6\n");
            mill.fit_tool(length);
            mill.bench.board.byte_link.send("~");
            for (unsigned i = 0; i < 20; ++i) {
                const unsigned ticks = 1 + static_cast<unsigned>(random() % 400);
                said += mill.bench.exchange(i % 2 == 0 ? "!" : "~", ticks);
            }
            said += mill.say("~");
            DOUBLES_EQUAL_TEXT(length, mill.offset(), kTouchOffAccuracy, where.c_str());
            mill.is_at(-10, -20, -30 + mill.offset());
        }
        UNSIGNED_LONGS_EQUAL_TEXT(4, count_of(said, "ok\r\n"), where.c_str());
        UNSIGNED_LONGS_EQUAL_TEXT(0, count_of(said, "ALARM") + count_of(said, "error"),
                                  where.c_str());
    }
}
