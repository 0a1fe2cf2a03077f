// The rotary axis A: words, offsets, reports, settings, and its steps on the fourth motor's lines.
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/machine/stored_state.hpp"
#include "tests/support/controller_bench.hpp"

using namespace cusp;
using machine::Setting;

namespace {

constexpr double kNear = 1e-6;

// 100 steps a degree, 3600 degrees a minute.
machine::Settings with_rotary()
{
    machine::Settings settings;
    settings.put(793, 4);
    settings.put(103, 100);
    settings.put(113, 3600);
    settings.put(22, 0);
    return settings;
}

}  // namespace

TEST_GROUP(RotaryAxis)
{
    ControllerBench bench{{}, with_rotary()};

    void setup() override { bench.exchange(""); }
    std::string send(const std::string& line)
    {
        std::string answers = bench.exchange(line + "\n");
        return answers + bench.finish();
    }
    void take(const std::string& line)
    {
        const std::string answers = send(line);
        CHECK_TEXT(has_text(answers, "ok"), (line + ": " + answers).c_str());
    }
    void refuse(const std::string& line, const std::string& error)
    {
        const std::string answers = send(line);
        CHECK_TEXT(has_text(answers, error), (line + ": " + answers).c_str());
    }
};

TEST(RotaryAxis, TurnsByItsWordsAlongLinesArcsAndAlone)
{
    take("G21 G90 G1 F600 A90");
    DOUBLES_EQUAL(90, bench.turned(), kNear);
    take("X10 A-30.5");
    DOUBLES_EQUAL(-30.5, bench.turned(), kNear);
    DOUBLES_EQUAL(10, bench.position().x, kNear);
    take("G91 G0 A5 Y2");
    DOUBLES_EQUAL(-25.5, bench.turned(), kNear);
    take("G90 G2 X20 Y2 I5 A0");
    DOUBLES_EQUAL(0, bench.turned(), kNear);
    DOUBLES_EQUAL(20, bench.position().x, kNear);
}

TEST(RotaryAxis, IsInDegreesInInchesToo)
{
    take("G20 G0 X1 A10");
    DOUBLES_EQUAL(10, bench.turned(), kNear);
    DOUBLES_EQUAL(25.4, bench.position().x, kNear);
    take("$13=1");
    const std::string report = bench.exchange("?");
    CHECK_TEXT(has_text(report, "MPos:1.0000,0.0000,0.0000,10.000"), report.c_str());
}

TEST(RotaryAxis, MakesItsStepsOnTheFourthMotorsLines)
{
    take("G0 A2");
    LONGS_EQUAL(200, bench.board.mill.steps()[3]);
    take("G0 A-1 X1");
    LONGS_EQUAL(-100, bench.board.mill.steps()[3]);
    LONGS_EQUAL(500, bench.board.mill.steps_taken()[3]);
    LONGS_EQUAL(800, bench.board.mill.steps()[0]);
}

TEST(RotaryAxis, HasOffsetsOfItsOwn)
{
    take("G0 A40");
    take("G92 A10");
    take("G0 A0");
    DOUBLES_EQUAL(30, bench.turned(), kNear);
    take("G92.1");
    take("G10 L2 P1 A5");
    take("G0 A0");
    DOUBLES_EQUAL(5, bench.turned(), kNear);
    take("G10 L20 P1 A90");
    const std::string listed = send("$#");
    CHECK_TEXT(has_text(listed, "[G54:0.000,0.000,0.000,-85.000]"), listed.c_str());
    take("G28.1");
    take("G0 X3 A7");
    take("G28 A7");
    DOUBLES_EQUAL(5, bench.turned(), kNear);
    DOUBLES_EQUAL(3, bench.position().x, kNear);
    take("G53 G0 A1");
    DOUBLES_EQUAL(1, bench.turned(), kNear);
}

TEST(RotaryAxis, JogsAndHolds)
{
    bench.exchange("$J=G91 A20 F3000\n", 60);
    const double amid = bench.turned();
    CHECK(amid > 0 && amid < 20);
    bench.exchange("\x85", 2);
    bench.finish();
    CHECK(bench.turned() >= amid && bench.turned() < 20);
    refuse("$J=G91 B20 F3000", "error:20");
}

// A feed is that of X, Y and Z where they move, and degrees a minute where A moves alone.
TEST(RotaryAxis, LeavesTheFeedToTheLinearAxes)
{
    const auto seconds = [this](const std::string& line) {
        const std::uint32_t before = bench.app.machine().motion().ticks();
        take(line);
        return static_cast<double>(bench.app.machine().motion().ticks() - before) * 1e-3;
    };
    DOUBLES_EQUAL(20, seconds("G90 G1 F60 X20 A60"), 0.3);
    DOUBLES_EQUAL(6, seconds("F600 A0"), 0.3);
    DOUBLES_EQUAL(12, seconds("G93 F5 X0 A30"), 0.3);
    // Its greatest speed, 60 degrees/s, bounds both.
    DOUBLES_EQUAL(10, seconds("G94 F6000 X1 A630"), 0.4);
}

TEST(RotaryAxis, IsRefusedWhereNothingWouldTurn)
{
    refuse("G38.2 X5 A10 F100", "error:20");
    take("G0 X0 Y0");
    refuse("G5.2 X5 Y5 A10 F100", "error:20");
    take("G1 X1 F100");
    refuse("G1 B10", "error:20");
}

TEST(RotaryAxis, WordsOfOthersStandStillWithANote)
{
    const std::string answers = send("G1 F100 A1 B0 C0");
    CHECK_TEXT(has_text(answers, "stand still"), answers.c_str());
    DOUBLES_EQUAL(1, bench.turned(), kNear);
}

TEST(RotaryAxis, DrillsAroundItself)
{
    take("G90 G0 Z0 A0");
    take("G81 X1 A30 Z-2 R-1 F600");
    DOUBLES_EQUAL(30, bench.turned(), kNear);
    take("A60");
    DOUBLES_EQUAL(60, bench.turned(), kNear);
    take("G80");
}

TEST(RotaryAxis, ListsItsSettingsOnlyWhereItIs)
{
    const std::string with = send("$$");
    CHECK(has_text(with, "$103=100.000") && has_text(with, "$803="));
    take("$793=0");
    const std::string without = send("$$");
    CHECK(!has_text(without, "$103=") && !has_text(without, "$803="));
    refuse("G1 A10 F100", "ok");  // the first word of an axis that is not there stands still
    refuse("A20", "error:20");
    const std::string report = bench.exchange("?");
    CHECK_TEXT(has_text(report, "MPos:0.000,0.000,0.000|"), report.c_str());
}

// A second motor and A are the same plug: the steps of neither reach the other.
TEST(RotaryAxis, LeavesTheLinesToASecondMotor)
{
    take("G0 A2");
    const auto before = bench.board.mill.steps_taken()[3];
    take("$793=2");
    take("G0 Y1");
    LONGS_EQUAL(before + 800, bench.board.mill.steps_taken()[3]);
    DOUBLES_EQUAL(2, bench.turned(), kNear);
}

TEST(RotaryAxis, StepsTooFastAreRefused)
{
    refuse("$113=100000", "ok");
    refuse("$103=10000", "error:");
}

// A record of a machine without A: all of it has its place, and A has its defaults.
TEST(RotaryAxis, ReadsWhatWasStoredWithoutIt)
{
    constexpr std::size_t kSettings = machine::kSettingCount - 11;
    constexpr std::size_t kThree = sizeof(Vec3<std::int64_t>);
    machine::StoredState old{};
    std::uint8_t* const bytes = old.bytes().begin();
    std::size_t place = 0;
    const auto put = [&](const void* from, std::size_t size) {
        __builtin_memcpy(bytes + place, from, size);
        place += size;
    };
    for (std::size_t i = 0; i < kSettings; ++i) {
        const auto value = static_cast<float>(i);
        put(&value, sizeof value);
    }
    place = (place + 7) / 8 * 8;
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(gcode::Parameters::kPositions); ++i) {
        const Vec3<std::int64_t> at{3 * i, 3 * i + 1, 3 * i + 2};
        put(&at, kThree);
    }
    const std::int64_t length = 77;
    put(&length, sizeof length);

    old.widen(machine::kLayoutNumber, machine::Settings{});
    float expected = 0;
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        const machine::SettingEntry& entry = machine::setting_entry(i);
        const bool of_rotary = entry.since == machine::kLayoutWithRotary;
        DOUBLES_EQUAL(of_rotary ? entry.standard : expected, old.settings.value_at(i), 0);
        expected += of_rotary ? 0 : 1;
    }
    CHECK(old.parameters.work_offsets[0] == (Position{0, 1, 2, 0}));
    CHECK(old.parameters.work_offsets[8] == (Position{24, 25, 26, 0}));
    CHECK(old.parameters.home == (Position{27, 28, 29, 0}));
    CHECK(old.parameters.coordinate_offset == (Position{33, 34, 35, 0}));
    LONGS_EQUAL(77, old.parameters.tool_length_offset_nm);
}
