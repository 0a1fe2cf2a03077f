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
}
