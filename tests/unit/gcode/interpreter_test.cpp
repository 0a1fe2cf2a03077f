// The dialect: moves, modal state, offsets, and each refusal with Grbl's number.
#include "firmware/gcode/interpreter.hpp"

#include <variant>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "tests/unit/gcode/gcode_runner.hpp"

using namespace cusp;
using namespace cusp::gcode;

TEST_GROUP(Interpreter)
{
    Runner runner;
    void run(std::string_view line) { LONGS_EQUAL_TEXT(0, runner.run(line), line.data()); }
    void refuse(int error, std::string_view line)
    {
        const ModalState before = runner.interpreter.modal();
        const Position at = runner.interpreter.position();
        const std::size_t actions = runner.actions.size();
        LONGS_EQUAL_TEXT(error, runner.run(line), line.data());
        CHECK(at == runner.interpreter.position());
        LONGS_EQUAL(actions, runner.actions.size());
        CHECK(before.motion == runner.interpreter.modal().motion);
        CHECK(before.feed == runner.interpreter.modal().feed);
        CHECK(before.inches == runner.interpreter.modal().inches);
        CHECK(before.incremental == runner.interpreter.modal().incremental);
        CHECK(before.spindle == runner.interpreter.modal().spindle);
    }
    void at(double x, double y, double z)
    {
        check_position(x, y, z, runner.interpreter.position());
    }
};

TEST(Interpreter, MovesInMillimetresAndInches)
{
    run("G21 G90 G0 X1.5 y-2.25");
    run("G1 F600 Z-0.000001");
    at(1.5, -2.25, -0.000001);
    DOUBLES_EQUAL(10, static_cast<double>(runner.last_move().feed), 1e-6);
    run("G20 X1 F10");
    at(25.4, -2.25, -0.000001);
    DOUBLES_EQUAL(254.0 / 60, static_cast<double>(runner.last_move().feed), 1e-6);
}

TEST(Interpreter, UnderstandsCommentsSpacesAndLowerCase)
{
    run("  g1 (to the (left) x 1 0 . 5 f1 00 ; and so on X99");
    at(10.5, 0, 0);
    run("/ x11 (open comment x12");
    at(11, 0, 0);
    run("%");
    run("");
    run("(nothing)");
    run("% X5");
    LONGS_EQUAL(2, runner.actions.size());
}

TEST(Interpreter, CarriesTheRemainderOfIncrementalMoves)
{
    run("G91 G20 G1 F10");
    for (int i = 0; i < 300; ++i) {
        run("X0.0000333333333");
    }
    // 300 * 0.0000333333333 in = 0.253999999746 mm
    LONGS_EQUAL(254000, runner.interpreter.position().x);
}

TEST(Interpreter, ComesBackAfterAMillionIncrementalMoves)
{
    run("G91 G20 G1 F10");
    for (int i = 0; i < 100000; ++i) {
        run("X0.000123456");
        run("X-0.000123456");
        run("Y.1Z-.03");
        run("Y-.1Z.03");
        runner.actions.clear();
    }
    at(0, 0, 0);
}

TEST(Interpreter, MakesArcsByCentreAndRadiusInAllPlanes)
{
    run("G1 F100");
    run("G2 X10 Y10 I10");
    at(10, 10, 0);
    run("G3 X0 Y0 R10");
    run("G18 G2 X0 Z20 K10");
    run("G19 G3 Y0 Z0 R-10");
    run("G17 G2 X0 Y0 I5 P3 Z1");
    at(0, 0, 1);
    LONGS_EQUAL(5, runner.moves().size());
    const auto& arc = std::get<path::Arc>(runner.last_move().path);
    DOUBLES_EQUAL(6 * 3.14159265358979, arc.sweep, 1e-12);
}

TEST(Interpreter, KnowsInverseTimeFeed)
{
    run("G93 G1 X10 F2");
    DOUBLES_EQUAL(10 * 2 / 60.0, static_cast<double>(runner.last_move().feed), 1e-6);
    refuse(22, "X20");
    refuse(22, "G94 G1 X20");
    run("G94 X20 F60");
}

TEST(Interpreter, AppliesWorkOffsetsToolLengthAndG92)
{
    run("G10 L2 P1 X10 Y20 Z30");
    run("G0 X1 Y1 Z1");
    at(11, 21, 31);
    run("G43.1 Z5");
    run("G0 Z1");
    at(11, 21, 36);
    run("G92 X0");
    run("G0 X1");
    at(12, 21, 36);
    run("G10 L20 P0 Y5");
    run("G0 Y5");
    at(12, 21, 36);
    run("G53 G0 X0 Y0 Z0");
    at(0, 0, 0);
    run("G92.1");
    run("G49");
    run("G0 X0 Z0");
    at(10, 0, 30);
    run("G59.3");
    run("X0 Y0 Z0");
    at(0, 0, 0);
}

TEST(Interpreter, GoesHomeThroughAPoint)
{
    run("G0 X5 Y6 Z7");
    run("G28.1");
    run("G0 X0 Y0 Z0");
    run("G91 G28 Z10");
    at(0, 0, 7);
    LONGS_EQUAL(4, runner.moves().size());
    check_position(0, 0, 10, runner.moves()[2].end);
    run("G28");
    at(5, 6, 7);
    run("G30 X0");
    at(0, 6, 7);
    run("G30.1");
    run("G90 G0 X9 Y9 Z9");
    run("G30");
    at(0, 6, 7);
    run("G28 Z9");
    at(0, 6, 7);
    run("G28");
    at(5, 6, 7);
}

TEST(Interpreter, YieldsActionsInGrblsOrder)
{
    run("M30 G4 P1.5 M8 S1000 M3 T4 M6 G1 X1 F10");
    LONGS_EQUAL(6, runner.actions.size());
    LONGS_EQUAL(4, std::get<ToolChange>(runner.actions[0]).tool);
    CHECK(std::get<Spindle>(runner.actions[1]).mode == SpindleMode::kClockwise);
    DOUBLES_EQUAL(1000, static_cast<double>(std::get<Spindle>(runner.actions[1]).speed), 0);
    CHECK(std::get<Coolant>(runner.actions[2]) == Coolant::kFlood);
    DOUBLES_EQUAL(1.5, std::get<Dwell>(runner.actions[3]).seconds, 0);
    CHECK(std::holds_alternative<path::Move>(runner.actions[4]));
    CHECK(std::holds_alternative<ProgramEnd>(runner.actions[5]));
    CHECK(runner.interpreter.modal().spindle == SpindleMode::kOff);
    CHECK(runner.interpreter.modal().motion == Motion::kLine);
}

TEST(Interpreter, KeepsThePathTolerance)
{
    runner.interpreter.set_default_tolerance(0.02F);
    run("G1 X1 F10");
    DOUBLES_EQUAL(0.02, static_cast<double>(runner.last_move().tolerance), 1e-9);
    run("G61 X2");
    DOUBLES_EQUAL(0, static_cast<double>(runner.last_move().tolerance), 0);
    run("G20 G64 P0.001 X0");
    DOUBLES_EQUAL(0.0254, static_cast<double>(runner.last_move().tolerance), 1e-9);
    run("G64 X2");
    DOUBLES_EQUAL(0.02, static_cast<double>(runner.last_move().tolerance), 1e-9);
    run("G61");
    run("M2");
    DOUBLES_EQUAL(0.02, static_cast<double>(runner.interpreter.path_tolerance()), 1e-9);
}

TEST(Interpreter, Probes)
{
    run("G38.2 Z-10 F100");
    const auto& probe = std::get<Probe>(runner.actions.back());
    CHECK(probe.alarm && !probe.away);
    runner.interpreter.set_position({0, 0, -3500000});
    run("G91 G0 Z1");
    at(0, 0, -2.5);
}

TEST(Interpreter, NumbersMovesByTheNWordOrTheCount)
{
    run("G0 X1");
    LONGS_EQUAL(1, runner.last_move().line);
    run("N77 X2");
    LONGS_EQUAL(77, runner.last_move().line);
}

TEST(Interpreter, JogsWithoutTouchingTheModalState)
{
    run("G0 X1");
    LONGS_EQUAL(0, runner.jog("G91 G20 X1 F100"));
    at(26.4, 0, 0);
    CHECK(!runner.interpreter.modal().inches);
    CHECK(!runner.interpreter.modal().incremental);
    CHECK(runner.last_move().kind == path::MoveKind::kFixedFeed);
    LONGS_EQUAL(22, runner.jog("X1"));
    LONGS_EQUAL(16, runner.jog("G1 X1 F100"));
    LONGS_EQUAL(16, runner.jog("M3 X1 F100"));
    LONGS_EQUAL(26, runner.jog("F100"));
    LONGS_EQUAL(36, runner.jog("X1 F100 S10"));
    LONGS_EQUAL(0, runner.jog("G53 X0 F100"));
    at(0, 0, 0);
}

TEST(Interpreter, ForgetsOnlyWhatAResetForgets)
{
    run("G10 L2 P2 X1");
    run("G55 G20 G91 G61 F10 M3 S100");
    run("G92 X1");
    runner.interpreter.reset();
    CHECK(!runner.interpreter.modal().inches);
    LONGS_EQUAL(0, runner.interpreter.modal().coordinate_system);
    LONGS_EQUAL(0, runner.interpreter.parameters().coordinate_offset.x);
    LONGS_EQUAL(1000000, runner.interpreter.parameters().work_offsets[1].x);
}

TEST(Interpreter, PassesOverWhatSaysNothingHere)
{
    run("O1001");
    run("N5 :1001 (bracket)");
    run("o0001 ; bracket");
    run("G97 S2000 M3");
    run("G64 P0.5 Q0.2");
    DOUBLES_EQUAL(0.5, static_cast<double>(runner.interpreter.path_tolerance()), 1e-9);
    run("G64 Q0.2");
    run("G61.1");
    DOUBLES_EQUAL(0, static_cast<double>(runner.interpreter.path_tolerance()), 0);
    run("G64 G83 R1 Z-1 Q0.5 X0 F100");
    refuse(36, "G1 Q1 X1");
}

TEST(Interpreter, MovesInALineWithG43)
{
    run("G43.1 Z5");
    run("G0 X1");
    run("G43 H1 Z50");
    at(1, 0, 50);
    run("G49 Z20");
    at(1, 0, 20);
    run("G92 X0");
    run("G92.2");
    run("X2");
    at(2, 0, 20);
    run("G80");
    refuse(31, "G43 H1 Z50");
}

TEST(Interpreter, RefusesBadWords)
{
    run("G1 F100");
    refuse(1, "G1 X1 #");
    refuse(1, "1");
    refuse(1, "X1-2");
    refuse(1, "X1.2.3");
    refuse(2, "X");
    refuse(2, "G1 Y-");
    refuse(4, "F-1");
    refuse(4, "N-1");
    refuse(20, "G5");
    refuse(20, "G5.1 X1");
    refuse(20, "G41");
    refuse(20, "M50");
    refuse(20, "E1");
    refuse(20, "X1E3");
    refuse(20, "G38.9 X1");
    refuse(20, "G61.2");
    refuse(20, "O100 sub");
    refuse(20, "O<x> call");
    refuse(20, "G1 O5");
    refuse(20, "O1.5");
    refuse(20, ":");
    refuse(20, "G96 S100");
    refuse(20, "G92.3");
    refuse(20, "G90.2");
    refuse(23, "G1.5 X1");
    refuse(23, "M3.5");
    refuse(24, "G0 G1 X1");
    refuse(21, "G17 G18");
    refuse(21, "M3 M5");
    refuse(24, "G1 G92 X1");
    refuse(24, "G10 G28 X1");
    refuse(25, "X1 X2");
    refuse(27, "N10000001 X1");
    refuse(38, "X200000");
    refuse(38, "T256");
    refuse(23, "T1.5");
}

TEST(Interpreter, RefusesWhatMotionCannotDo)
{
    refuse(22, "G1 X1");
    run("F100");
    refuse(26, "G2");
    refuse(26, "G2 R1");
    refuse(26, "G2 K1");
    refuse(32, "G2 Z1 K1");
    refuse(35, "G2 X1");
    refuse(33, "G2 X10 Y3 I1");
    refuse(33, "G2 X0 Y0 R1");
    refuse(34, "G2 X10 R1");
    refuse(33, "G2 X2 I1 P0");
    refuse(33, "G2 X2 I1 P1.5");
    refuse(36, "G2 X2 R1 K1");
    refuse(36, "G2 X2 R1 I1");
    refuse(36, "G0 X1 I1");
    refuse(36, "G1 P5");
    refuse(26, "G38.2");
    refuse(33, "G38.2 X0");
    refuse(30, "G53 G2 X2 I1");
    run("G80");
    refuse(31, "X1");
    refuse(33, "G5.3");
}

TEST(Interpreter, RefusesBadOffsets)
{
    refuse(26, "G10 L2 P1");
    refuse(28, "G10 L2 X1");
    refuse(28, "G10 P1 X1");
    refuse(29, "G10 L2 P10 X1");
    refuse(20, "G10 L3 P1 X1");
    refuse(20, "G10 L2 P1 X1 R5");
    refuse(26, "G92");
    refuse(28, "G4");
    refuse(37, "G43.1 X1");
    refuse(37, "G43.1 X1 Z1");
    refuse(4, "G43 H-1");
    refuse(24, "G4 P1 G64");
    run("G43 H1");
    LONGS_EQUAL(0, runner.interpreter.parameters().tool_length_offset_nm);
}

TEST(Interpreter, RefusesAWholeLineForOneBadWord)
{
    refuse(36, "G20 G91 M3 S500 F30 G1 X5 K2");
    refuse(38, "G92 X1 T300");
    LONGS_EQUAL(0, runner.interpreter.parameters().coordinate_offset.x);
}

TEST(Interpreter, IgnoresRotaryWordsThatStandStill)
{
    run("G0 A90 B0");
    CHECK(std::holds_alternative<RotaryIgnored>(runner.actions.back()));
    run("G1 X1 A90.0 F100");
    run("G91 X1 A0 B-0");
    at(2, 0, 0);
    LONGS_EQUAL(3, runner.actions.size());
    refuse(20, "G91 A1");
    refuse(20, "G90 A0");
    // A feed move has been made with C where it was: at 0.
    refuse(20, "G90 X3 C5");
    run("C0 G90 X3");
    refuse(20, "G10 L2 P1 A90");
    run("G10 L2 P1 A0");
    at(3, 0, 0);
    // G28 A0 moves none of the axes that there are.
    run("G28 A90");
    at(3, 0, 0);
    run("M2");
    run("A45");
    LONGS_EQUAL(20, runner.jog("X1 F100 A45"));
}

TEST(Interpreter, TakesTheLengthOfTheToolInTheSpindle)
{
    run("G10 L1 P1 Z10");
    run("G10 L1 P2 Z20");
    run("G43");
    LONGS_EQUAL(0, runner.interpreter.parameters().tool_length_offset_nm);
    run("T1 M6 G43");
    LONGS_EQUAL(to_nanometres(10), runner.interpreter.parameters().tool_length_offset_nm);
    // T alone changes nothing; a reset changes no tool.
    run("T2 G43");
    LONGS_EQUAL(to_nanometres(10), runner.interpreter.parameters().tool_length_offset_nm);
    run("M6");
    run("G43");
    LONGS_EQUAL(to_nanometres(20), runner.interpreter.parameters().tool_length_offset_nm);
    runner.interpreter.reset();
    run("G43");
    LONGS_EQUAL(to_nanometres(20), runner.interpreter.parameters().tool_length_offset_nm);
    run("T3 M6");
    refuse(38, "G43");
}

TEST(Interpreter, TakesAByteOrderMarkForABlank)
{
    run("\xEF\xBB\xBF%");
    run("\xEF\xBB\xBFG0 X1");
    at(1, 0, 0);
    refuse(1, "G0 \xEF\xBB\xBFX1");
}

TEST(Interpreter, TurnsCirclesWithoutAxisWordsInEveryPlane)
{
    run("G1 F100");
    for (const char* line : {"G17 G2 I5", "J3", "G18 K2", "I1 P2", "G19 G3 J4", "K-1"}) {
        run(line);
        const auto& move = runner.last_move();
        CHECK(move.start == move.end);
        const double turns = line[0] == 'I' && line[1] == '1' ? 2 : 1;
        DOUBLES_EQUAL(turns * 2 * kPi, std::get<path::Arc>(move.path).sweep, 1e-12);
    }
    run("G17 G2 I5 Z-1");
    at(0, 0, -1);
    DOUBLES_EQUAL(2 * kPi, std::get<path::Arc>(runner.last_move().path).sweep, 1e-12);
    refuse(32, "G2 Z1 R5");
    refuse(26, "G2 K1");
}

TEST(Interpreter, PutsCentresWhereTheyAreSaidToBe)
{
    run("G54 G10 L2 P1 X100 Y50 Z-7");
    run("G0 X5 Y5 Z0");
    run("G90.1 G2 X15 Y5 I10 J5 F100");
    DOUBLES_EQUAL(5, std::get<path::Arc>(runner.last_move().path).radius, 1e-9);
    at(115, 55, -7);
    // Coordinates also in G91.
    run("G91 X-10 I10 J5");
    at(105, 55, -7);
    run("G90 G18 G2 Z4 X5 K2 I5");
    DOUBLES_EQUAL(2, std::get<path::Arc>(runner.last_move().path).radius, 1e-9);
    refuse(35, "X6 K1");
    run("M2");
    run("G0 X0 Y0");
    run("G2 X10 I5");
    DOUBLES_EQUAL(5, std::get<path::Arc>(runner.last_move().path).radius, 1e-9);
}

TEST(Interpreter, IgnoresG80BesideAMotion)
{
    run("G80 G0 X1");
    run("X2");
    run("G1 G80 X3 F100");
    run("G80 G81 X4 Z-1 R1");
    run("X5");
    refuse(31, "G80 X5");
    refuse(21, "G80 G5.3");
}

TEST(Interpreter, NumbersLinesByTheWholePartOfN)
{
    run("N10.75 G0 X1");
    LONGS_EQUAL(10, runner.last_move().line);
    refuse(27, "N10000001.5 X2");
}
