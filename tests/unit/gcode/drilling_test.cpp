// G81 to G83: holes, heights, pecks, repeats.
#include <variant>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"
#include "tests/unit/gcode/gcode_runner.hpp"

using namespace cusp;
using namespace cusp::gcode;

TEST_GROUP(Drilling)
{
    Runner runner;
    void setup() override
    {
        LONGS_EQUAL(0, runner.run("G21 G90 G0 Z5 F100"));
        runner.actions.clear();
    }
    void run(std::string_view line) { LONGS_EQUAL_TEXT(0, runner.run(line), line.data()); }
    void move(unsigned index, path::MoveKind kind, double x, double y, double z)
    {
        const auto& found = std::get<path::Move>(runner.actions[index]);
        CHECK(found.kind == kind);
        check_position(x, y, z, found.end);
    }
};

constexpr auto kRapid = path::MoveKind::kRapid;
constexpr auto kFeed = path::MoveKind::kFeed;

TEST(Drilling, DrillsAndReturnsToTheFirstHeight)
{
    run("G81 X10 Z-3 R1");
    LONGS_EQUAL(4, runner.actions.size());
    move(0, kRapid, 10, 0, 5);
    move(1, kRapid, 10, 0, 1);
    move(2, kFeed, 10, 0, -3);
    move(3, kRapid, 10, 0, 5);
    run("Y10");
    LONGS_EQUAL(8, runner.actions.size());
    check_position(10, 10, 5, runner.interpreter.position());
}

TEST(Drilling, ReturnsToClearanceWithG99)
{
    run("G99 G82 X10 Z-3 R1 P0.5");
    LONGS_EQUAL(5, runner.actions.size());
    DOUBLES_EQUAL(0.5, std::get<Dwell>(runner.actions[3]).seconds, 0);
    move(4, kRapid, 10, 0, 1);
    check_position(10, 0, 1, runner.interpreter.position());
}

TEST(Drilling, PecksDownToTheBottom)
{
    run("G83 X0 Z-2.5 R1 Q2");
    LONGS_EQUAL(6, runner.actions.size());
    move(0, kRapid, 0, 0, 1);
    move(1, kFeed, 0, 0, -1);
    move(2, kRapid, 0, 0, 1);
    move(3, kRapid, 0, 0, -1 + 0.254);
    move(4, kFeed, 0, 0, -2.5);
    move(5, kRapid, 0, 0, 5);
}

TEST(Drilling, RepeatsInIncrementalSteps)
{
    run("G91 G98 G81 X10 Y1 Z-2 R-4 L3");
    check_position(30, 3, 5, runner.interpreter.position());
    LONGS_EQUAL(12, runner.actions.size());
    move(10, kFeed, 30, 3, -1);
}

TEST(Drilling, NeedsItsWords)
{
    LONGS_EQUAL(28, runner.run("G81 X1 Z-1"));
    LONGS_EQUAL(28, runner.run("G81 X1 R1"));
    LONGS_EQUAL(28, runner.run("G82 X1 Z-1 R1"));
    LONGS_EQUAL(28, runner.run("G83 X1 Z-1 R1"));
    LONGS_EQUAL(33, runner.run("G83 X1 Z-1 R1 Q0"));
    LONGS_EQUAL(33, runner.run("G81 X1 Z2 R1"));
    LONGS_EQUAL(33, runner.run("G81 X1 Z-1 R1 L0"));
    LONGS_EQUAL(26, runner.run("G81"));
    LONGS_EQUAL(36, runner.run("G81 X1 Z-1 R1 Q1"));
    CHECK(runner.actions.empty());
    run("G81 X1 Z-1 R1");
    run("G80");
    LONGS_EQUAL(31, runner.run("X2"));
    LONGS_EQUAL(28, runner.run("G81 X2"));
    for (const char* line : {"G73 X1 Z-1 R1", "G86 X1 Z-1 R1 M3", "G89 X1 Z-1 R1"}) {
        LONGS_EQUAL_TEXT(28, runner.run(line), line);
    }
    LONGS_EQUAL(36, runner.run("G85 X1 Z-1 R1 P1"));
    LONGS_EQUAL(33, runner.run("G86 X1 Z-1 R1 P1"));
    LONGS_EQUAL(33, runner.run("G73 X1 Z-1 R1 Q0"));
}

// The values of these tests are those of LinuxCNC's rs274.
TEST(Drilling, HoldsTheInitialLevelThroughASeries)
{
    run("G99 G81 X5 Z-2 R1");
    run("G83 X6 Z-2 R2 Q9");
    run("G98 X7");
    check_position(7, 0, 5, runner.interpreter.position());
    run("G99 X8");
    run("G0 X9");
    run("G98 G81 X10 Z-2 R1");
    check_position(10, 0, 2, runner.interpreter.position());
}

TEST(Drilling, RisesFirstWhereRIsAboveTheInitialLevel)
{
    run("G98 G81 X1 Z-1 R8");
    move(0, kRapid, 0, 0, 8);
    move(1, kRapid, 1, 0, 8);
    run("X2 R2");
    check_position(2, 0, 5, runner.interpreter.position());
}

TEST(Drilling, HoldsTheInitialLevelInProgramCoordinates)
{
    run("G99 G81 X1 Z-1 R2");
    run("G10 L2 P2 Z-20");
    run("G55");
    runner.actions.clear();
    run("G98 X2");
    move(0, kRapid, 2, 0, 2);
    move(1, kRapid, 2, 0, -18);
    move(2, kFeed, 2, 0, -21);
    move(3, kRapid, 2, 0, -15);
}

TEST(Drilling, CountsRFromTheInitialLevelInG91)
{
    run("G91 G99 G81 X10 Z-3 R-2");
    run("X10");
    run("X10 L2");
    unsigned bottoms = 0;
    for (const path::Move& found : runner.moves()) {
        if (found.kind == kFeed) {
            LONGS_EQUAL(0, found.end.z);
            ++bottoms;
        }
    }
    LONGS_EQUAL(4, bottoms);
    check_position(40, 0, 3, runner.interpreter.position());
    run("G98 X1");
    check_position(41, 0, 5, runner.interpreter.position());
}

TEST(Drilling, BreaksChipsWithoutLeavingTheHole)
{
    run("G73 X0 Z-2.5 R1 Q2");
    LONGS_EQUAL(5, runner.actions.size());
    move(1, kFeed, 0, 0, -1);
    move(2, kRapid, 0, 0, -1 + 0.254);
    move(3, kFeed, 0, 0, -2.5);
    move(4, kRapid, 0, 0, 5);
}

TEST(Drilling, BoresOutAtTheFeed)
{
    run("G85 X0 Z-2 R1");
    move(2, kFeed, 0, 0, 1);
    move(3, kRapid, 0, 0, 5);
    run("G80");
    runner.actions.clear();
    run("G89 X0 Z-2 R1 P0.5");
    DOUBLES_EQUAL(0.5, std::get<Dwell>(runner.actions[2]).seconds, 0);
    move(3, kFeed, 0, 0, 5);
    LONGS_EQUAL(4, runner.actions.size());
}

TEST(Drilling, StopsTheSpindleOnTheWayOut)
{
    run("M4 S500");
    runner.actions.clear();
    run("G86 X3 Z-2 R1 P0.5 L2");
    LONGS_EQUAL(13, runner.actions.size());
    CHECK(std::get<Spindle>(runner.actions[4]).mode == SpindleMode::kOff);
    move(5, kRapid, 3, 0, 5);
    const auto& again = std::get<Spindle>(runner.actions[6]);
    CHECK(again.mode == SpindleMode::kCounterClockwise);
    DOUBLES_EQUAL(500, static_cast<double>(again.speed), 0);
}

TEST(Drilling, HasItsHeightsAlongTheAxisSquareToThePlane)
{
    run("G0 X5 Y5");
    runner.actions.clear();
    run("G18 G99 G85 X1 Z-1 Y1 R2");
    move(0, kRapid, 1, 5, -1);
    move(1, kRapid, 1, 2, -1);
    move(2, kFeed, 1, 1, -1);
    move(3, kFeed, 1, 2, -1);
    // Another plane begins another series: the level is X, not that of Y.
    run("G19 G98 G81 Y0 Z0 X-3 R0");
    check_position(1, 0, 0, runner.interpreter.position());
}
