// G5.2, G5.3 and G6.2 as LinuxCNC and Fanuc write them.
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/gcode/gcode_runner.hpp"

using namespace cusp;
using namespace cusp::gcode;

TEST_GROUP(Curves)
{
    Runner runner;
    void setup() override { LONGS_EQUAL(0, runner.run("G21 G90 F300")); }
    void run(std::string_view line) { LONGS_EQUAL_TEXT(0, runner.run(line), line.data()); }
    void check_chain()
    {
        Position at = runner.moves().front().start;
        for (const path::Move& move : runner.moves()) {
            CHECK(at == move.start);
            at = move.end;
        }
        CHECK(at == runner.interpreter.position());
    }
};

TEST(Curves, RunAUniformNurbs)
{
    run("G5.2 X3.53 Y-1.50 P2");
    run("X5.33 Y-11.01 P1");
    run("(in between)");
    run("N9 X3.52 Y-24.00 P1");
    run("X0.0 Y-29.56 P1");
    run("G5.3");
    check_chain();
    check_position(0, -29.56, 0, runner.interpreter.position());
    CHECK(runner.moves().size() >= 3);
    LONGS_EQUAL(31, runner.run("X1"));
}

TEST(Curves, WeightTheFirstPointWithPAlone)
{
    run("G5.2 P1 L4");
    run("X10 P1");
    run("X20 Y1 P1");
    // Three points for an order of four.
    LONGS_EQUAL(33, runner.run("G5.3"));
    CHECK(runner.actions.empty());
    check_position(0, 0, 0, runner.interpreter.position());
}

TEST(Curves, CountTheirFirstPointFromWhereTheToolIs)
{
    run("G0 X1 Y2");
    runner.actions.clear();
    LONGS_EQUAL(33, runner.run("G6.2 X1.0015 Y2 K0 P3"));
    run("G6.2 X1.0005 Y2 K0 P3");
    run("X10 Y0 K0");
    run("X10 Y10 K0 R0.7");
    run("X20 Y10 K1");
    CHECK(runner.actions.empty());
    run("K2");
    CHECK(!runner.actions.empty());
    run("G6.2 K2");
    run("G6.2 K2");
    check_chain();
    check_position(20, 10, 0, runner.interpreter.position());
    LONGS_EQUAL(20, runner.run("G7"));
}

TEST(Curves, LeftOpenAreRefusedAndGivenUp)
{
    for (const char* line : {"G1 X5", "M30", "M2", "G4 P1", "G6.2 X5 K0", "M3", "G91"}) {
        Runner fresh;
        LONGS_EQUAL(0, fresh.run("F100 G5.2 L2 X10"));
        LONGS_EQUAL(0, fresh.run("X20"));
        const Position at = fresh.actions.empty() ? Position{} : fresh.last_move().end;
        LONGS_EQUAL_TEXT(33, fresh.run(line), line);
        CHECK(at == fresh.interpreter.position());
        LONGS_EQUAL_TEXT(31, fresh.run("X30"), line);
    }
}

TEST(Curves, RefuseBadOrdersWeightsAndWords)
{
    LONGS_EQUAL(33, runner.run("G5.2 L6"));
    LONGS_EQUAL(33, runner.run("G5.2 L1"));
    LONGS_EQUAL(33, runner.run("G6.2 P2.5 K0"));
    LONGS_EQUAL(33, runner.run("G6.2 R0 K0"));
    LONGS_EQUAL(28, runner.run("G6.2 P3"));
    LONGS_EQUAL(36, runner.run("G5.2 K1"));
    LONGS_EQUAL(36, runner.run("G6.2 K1 L3"));
    LONGS_EQUAL(22, runner.run("G93 F1 G6.2 K1"));
    CHECK(runner.actions.empty());
    runner.interpreter.reset();
    LONGS_EQUAL(22, runner.run("G5.2"));
}

TEST(Curves, RefuseBadKnots)
{
    for (const char* line : {"X3 K-1", "X3 K0", "X3", "K0", "X3 K1 R-1", "X3 K1 F5", "K1 R2"}) {
        Runner fresh;
        for (const char* good : {"F100 G6.2 K0 P3", "X1 K0", "X2 Y1 K0"}) {
            LONGS_EQUAL(0, fresh.run(good));
        }
        CHECK_TEXT(fresh.run(line) != 0, line);
        CHECK(fresh.interpreter.modal().motion == Motion::kNone);
        CHECK(fresh.actions.empty());
    }
}
