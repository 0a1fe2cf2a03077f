// The text of a written program, and the radii of rounded arcs.
#include "host_tools/geometry/toolpath/gcode_writer.hpp"

#include <cmath>
#include <random>
#include <regex>
#include <sstream>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "tests/unit/toolpath/straight_moves.hpp"
using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::toolpath;

namespace {

PlannedOperation operation(std::vector<ToolMove> moves, int tool = 1)
{
    PlannedOperation planned;
    planned.path.tool = {tool, ToolShape::kBall, 6, 6};
    planned.path.feed = 1200;
    planned.path.plunge_feed = 300;
    planned.path.spindle = 12000;
    planned.path.moves = std::move(moves);
    return planned;
}

std::string written(const std::vector<PlannedOperation>& operations, bool inch = false)
{
    std::ostringstream out;
    write_program(out, {"cusp job.toml", inch, 5.0, {}}, operations);
    return out.str();
}

}  // namespace

TEST_GROUP(GcodeWriter){};

TEST(GcodeWriter, WritesAWholeProgram)
{
    const std::string expected =
        "(cusp job.toml)\nG17 G21 G40 G49 G54 G80 G90 G94\nG0 Z5\nG61\n"
        "(tool 1 ball diameter 12 mm)\nT1\nM3 S12000\nG0 X1 Y2 Z5\nG1 Z-1 F300\n"
        "G1 X3.5 F1200\nG0 Z5\nM5\nM30\n";
    STRCMP_EQUAL(expected.c_str(), written({operation({rapid({1, 2, 5}),
                                                       {MoveKind::kPlunge, LineTo{{1, 2, -1}}},
                                                       cut({3.5, 2, -1}),
                                                       rapid({3.5, 2, 5})})})
                                       .c_str());
}

TEST(GcodeWriter, RetractsAtTheEndWhereThePathDoesNot)
{
    STRCMP_CONTAINS(
        "G1 X2 F1200\nG0 Z5\nM5\nM30\n",
        written({operation({rapid({1, 2, 5}), rapid({1, 2, 0}), cut({2, 2, 0})})}).c_str());
}

TEST(GcodeWriter, ChangesToolsWithAStop)
{
    const std::string text = written({operation({rapid({1, 2, 5}), cut({1, 2, 1})}),
                                      operation({rapid({1, 2, 5}), cut({1, 2, 0})}, 2)});
    STRCMP_CONTAINS("G0 Z5\nM5\n(tool 2 ball diameter 12 mm)\nT2\nM0\nM3 S12000\n", text.c_str());
}

TEST(GcodeWriter, WritesInches)
{
    const std::string text =
        written({operation({rapid({25.4, 12.7, 5.08}), cut({25.4, 25.4 / 3, 5.08})})}, true);
    STRCMP_CONTAINS("G17 G20 G40", text.c_str());
    STRCMP_CONTAINS("G0 X1 Y0.5 Z0.2\nG1 Y0.33333 F47.244\n", text.c_str());
}

TEST(GcodeWriter, WritesNoExponents)
{
    const std::string text =
        written({operation({rapid({1e-7, -1e-7, 5}), cut({123456.78901, 1e-4, 5})})});
    CHECK(text.find("e-") == std::string::npos && text.find("e+") == std::string::npos);
    STRCMP_CONTAINS("G0 X0 Y0 Z5\n", text.c_str());
    STRCMP_CONTAINS("G1 X123456.789 Y0.0001", text.c_str());
}

TEST(GcodeWriter, DropsMovesThatVanishInRounding)
{
    const std::string text =
        written({operation({rapid({1, 1, 5}), cut({1.00001, 1, 5}), cut({2, 1, 5})})});
    STRCMP_CONTAINS("G0 X1 Y1 Z5\nG1 X2 F1200\n", text.c_str());
}

TEST(GcodeWriter, WritesArcsOfEveryPlane)
{
    const std::string text = written(
        {operation({rapid({10, 0, 5}),
                    {MoveKind::kCut, ArcTo{{0, 10, 5}, {0, 0, 0}, ArcPlane::kXY, false}},
                    {MoveKind::kCut, ArcTo{{-5, 10, 0}, {-5, 0, 5}, ArcPlane::kZX, true}},
                    {MoveKind::kCut, ArcTo{{-5, 12, 2}, {0, 12, 0}, ArcPlane::kYZ, true}}})});
    STRCMP_CONTAINS("G3 X0 Y10 I-10 F1200\nG18 G2 X-5 Z0 I-5\nG19 G2 Y12 Z2 J2\n", text.c_str());
}

TEST(GcodeWriter, WritesAFullCircle)
{
    STRCMP_CONTAINS(
        "G2 I-10 F1200\n",
        written({operation({rapid({10, 0, 5}),
                            {MoveKind::kCut, ArcTo{{10, 0, 5}, {0, 0, 0}, ArcPlane::kXY, true}}})})
            .c_str());
}

TEST(GcodeWriter, NeverMakesAFullCircleOfATinyArc)
{
    const double a = 1e-6;
    const ArcTo arc{{10 * std::cos(a), 10 * std::sin(a), 5}, {0, 0, 0}, ArcPlane::kXY, false};
    const std::string text = written({operation({rapid({10, 0, 5}), {MoveKind::kCut, arc}})});
    CHECK(text.find("G3") == std::string::npos);
}

TEST(GcodeWriter, KeepsTheRadiiOfRoundedArcsWithinHalfAMicrometre)
{
    const unsigned seed = 7;
    UtestShell::getCurrent()->print("seed 7 ", __FILE__, __LINE__);
    std::mt19937 engine{seed};
    std::uniform_real_distribution<double> unit{0, 1};
    for (const bool inch : {false, true}) {
        for (int n = 0; n < 20000; ++n) {
            const double radius = std::pow(10, -1 + 4 * unit(engine));
            const Vec2d c{200 * unit(engine), 200 * unit(engine)};
            const double from = 2 * kPi * unit(engine);
            const double to = from + 2 * kPi * unit(engine);
            const Vec3d start{c.x + radius * std::cos(from), c.y + radius * std::sin(from), 5};
            const Vec3d end{c.x + radius * std::cos(to), c.y + radius * std::sin(to), 5};
            const std::string text = written(
                {operation({rapid(start),
                            {MoveKind::kCut, ArcTo{end, {c.x, c.y, 0}, ArcPlane::kXY, false}}})},
                inch);
            const std::size_t at = text.find("G3");
            if (at == std::string::npos) {
                continue;
            }
            const double mm = inch ? 25.4 : 1.0;
            const auto word = [&](char letter, std::size_t begin, double otherwise) {
                const std::size_t line_end = text.find('\n', begin);
                const std::size_t found = text.find(letter, begin);
                return found < line_end ? std::stod(text.substr(found + 1)) * mm : otherwise;
            };
            const std::size_t first = text.find("G0 X");
            const double x0 = word('X', first, 0);
            const double y0 = word('Y', first, 0);
            const double i = word('I', at, 0);
            const double j = word('J', at, 0);
            const double r1 = std::hypot(word('X', at, x0) - x0 - i, word('Y', at, y0) - y0 - j);
            DOUBLES_EQUAL(std::hypot(i, j), r1, 0.0005);
        }
    }
}

TEST(GcodeWriter, WritesNurbsWithTheirKnots)
{
    const Curve curve{2, {0, 0, 0, 5, 5, 5}, {{0, 0, 5}, {1, 1, 5}, {2, 0, 5}}, {1, 0.5, 1}};
    STRCMP_CONTAINS(
        "G6.2 P3 K0 X0 Y0 Z5 F1200\nK0 X1 Y1 Z5 R0.5\nK0 X2 Y0 Z5\nK1\nK1\nK1\n",
        written({operation({rapid({0, 0, 5}), {MoveKind::kCut, NurbsTo{curve}}})}).c_str());
}

TEST(GcodeWriter, KeepsBracketsOutOfComments)
{
    PlannedOperation planned = operation({rapid({0, 0, 5})});
    planned.path.comments = {"a (b) c"};
    STRCMP_CONTAINS("(a [b] c)\n", written({planned}).c_str());
}

TEST(GcodeWriter, KeepsCommandsOfControllersOutOfComments)
{
    PlannedOperation planned = operation({rapid({0, 0, 5})});
    planned.path.comments = {"stop! 50% \x18 w\xc3\xb6?~"};
    STRCMP_CONTAINS("(stop_ 50_ _ w____)\n", written({planned}).c_str());
}

TEST(GcodeWriter, BreaksLongComments)
{
    PlannedOperation planned = operation({rapid({0, 0, 5})});
    const std::string word(40, 'a');
    planned.path.comments = {word + " " + word + " " + std::string(80, 'b')};
    STRCMP_CONTAINS(("(" + word + ")\n(" + word + ")\n(" + std::string(72, 'b') + ")\n(" +
                     std::string(8, 'b') + ")\n")
                        .c_str(),
                    written({planned}).c_str());
}
