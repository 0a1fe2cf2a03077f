// Programs as moves: what is read, and the file and line of errors.
#include "host_tools/judge/verify/program_moves.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::verify;

TEST_GROUP(ProgramMoves)
{
    cusp::test::TemporaryFolder folder;
    Program read(const std::string& text)
    {
        return read_program({}, folder.with("p.ngc", text), 100);
    }
    std::string refused(const std::string& text)
    {
        return cusp::test::refusal([&] { read(text); });
    }
};

TEST(ProgramMoves, FollowToolsAndCountKinds)
{
    const Program program = read(
        "G17 G21 G90 G94\r\nG0 Z5\nT1\nG0 X10 Y0\nG1 Z0 F300\n"
        "G3 X0 Y10 I-10 J0\nT2\nG1 X1\nM30\nG1 X99\n");
    LONGS_EQUAL(5, program.moves.size());
    LONGS_EQUAL(2, program.counts.rapids);
    LONGS_EQUAL(2, program.counts.lines);
    LONGS_EQUAL(1, program.counts.arcs);
    LONGS_EQUAL(0, program.moves[0].tool);
    LONGS_EQUAL(1, program.moves[3].tool);
    LONGS_EQUAL(2, program.moves[4].tool);
}

TEST(ProgramMoves, CountACurveOnce)
{
    const Program program = read(
        "G0 X0 Y0 Z0\nF500\nG6.2 P3 K0 X0 Y0\nK0 X1 Y1\nK0 X2 Y0\n"
        "K1 X3 Y1\nK2 X4 Y0\nK3\nK3\nK3\nM30\n");
    LONGS_EQUAL(1, program.counts.nurbs);
}

TEST(ProgramMoves, SampleArcsOnTheCircle)
{
    const Program program = read("G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F100\n");
    std::vector<Vec3d> points;
    append_points(program.moves.back().move, 0.1, points);
    Vec3d last{10, 0, 0};
    for (const Vec3d p : points) {
        DOUBLES_EQUAL(10, std::hypot(p.x, p.y), 1e-6);
        CHECK(norm(p - last) <= 0.1 + 1e-9);
        last = p;
    }
    DOUBLES_EQUAL(10, last.y, 1e-9);
}

TEST(ProgramMoves, FollowEveryCycle)
{
    for (const char* cycle : {"G81", "G82 P0", "G83 Q2", "G73 Q2", "G85", "G86 P0", "G89 P0"}) {
        const Program program = read(std::string{"G0 X0 Y0 Z10\nM3 S1000\nG99 F100\n"} + cycle +
                                     " X5 Z-3 R1\nX6\nG98 Y7\nG80\nM30\n");
        double deepest = 0;
        for (const ProgramMove& move : program.moves) {
            deepest = std::min(deepest, to_millimetres(move.move.end).z);
        }
        DOUBLES_EQUAL_TEXT(-3, deepest, 1e-9, cycle);
        const Vec3d end = xyz(to_millimetres(program.moves.back().move.end));
        DOUBLES_EQUAL_TEXT(6, end.x, 1e-9, cycle);
        DOUBLES_EQUAL_TEXT(7, end.y, 1e-9, cycle);
        DOUBLES_EQUAL_TEXT(10, end.z, 1e-9, cycle);
    }
}

TEST(ProgramMoves, NameTheLineThatCannotBeUsed)
{
    const std::string text = refused("G0 X1\nG1 X2 F100\nM99\n");
    STRCMP_CONTAINS("p.ngc:3", text.c_str());
    STRCMP_CONTAINS("error 20", text.c_str());
    STRCMP_CONTAINS("p.ngc:2", refused("G0 X1 Y0\nG2 X5 Y5 I9 J0 F100\n").c_str());
}

TEST(ProgramMoves, RefuseAnEmptyProgram)
{
    STRCMP_CONTAINS("no move", refused("(nothing)\n").c_str());
    STRCMP_CONTAINS("No such file", cusp::test::refusal([&] {
                                        read_program({}, folder.file("none.ngc"), 0);
                                    }).c_str());
}

TEST(ProgramMoves, AreThoseOfTheTipWhateverTheLengthOfTheTool)
{
    const std::string end = "T2 M6\nG43 H2\nG0 X5 Z3\nG2 X0 Y0 I-2.5\nG49\nG0 Z9\n";
    const Program with =
        read("G10 L1 P1 Z50\nG10 L1 P2 Z43.8\nT1 G43 H1 G0 Z5\nG1 X10 Z-2 F300\nZ1\n" + end);
    // With an empty table every length is 0, as in a controller where none was entered.
    const Program without = read("T1 G43 H1 G0 Z5\nG1 X10 Z-2 F300\nZ1\n" + end);
    LONGS_EQUAL(without.moves.size(), with.moves.size());
    for (std::size_t i = 0; i < with.moves.size(); ++i) {
        CHECK(without.moves[i].move.end == with.moves[i].move.end);
    }
    // The tip of the tool that is fitted goes from where the move before left the spindle.
    LONGS_EQUAL(50000000 - 43800000 + 1000000, with.moves[3].move.start.z);
}
