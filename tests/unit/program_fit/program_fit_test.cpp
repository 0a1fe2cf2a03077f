// Whole programs: words kept, modal state restored, tolerance held, real size.
#include "host_tools/controller/program_fit/program_fit.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/program_fit/fit_check.hpp"

using namespace cusp;
using namespace cusp::program_fit;

namespace {

// Lines on a circle of radius 10 about (0, 0), from angle 0.
std::string circle(int count, const char* prefix, double scale = 1)
{
    std::string text;
    for (int i = 1; i <= count; ++i) {
        char line[80];
        const double angle = 2 * 3.14159265358979 * i / 360;
        (void)std::snprintf(line, sizeof line, "%sX%.5fY%.5f\n", prefix,
                            10 / scale * std::cos(angle), 10 / scale * std::sin(angle));
        text += line;
    }
    return text;
}

FittedProgram fit(const std::string& text, double tolerance = 0.01)
{
    return fit_program(text, "p.ngc", tolerance);
}

bool contains(const std::string& text, const char* part)
{
    return text.find(part) != std::string::npos;
}

// End of a program, machine nanometres.
Position end_of(const std::string& text)
{
    gcode::Interpreter interpreter;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = text.find('\n', at);
        CHECK(
            static_cast<bool>(interpreter.execute(std::string_view{text}.substr(at, end - at), 1)));
        gcode::Action action;
        while (interpreter.next(action)) {
        }
        at = end + 1;
    }
    return interpreter.position();
}

std::string read_compressed(const std::string& file)
{
    std::string text;
    std::FILE* pipe = popen(("zcat '" + file + "'").c_str(), "r");
    CHECK(pipe != nullptr);
    char buffer[65536];
    for (std::size_t size = 1; size > 0;) {
        size = std::fread(buffer, 1, sizeof buffer, pipe);
        text.append(buffer, size);
    }
    pclose(pipe);
    return text;
}

}  // namespace

TEST_GROUP(FitProgram){};

TEST(FitProgram, MakesArcsOfLines)
{
    const FittedProgram fitted = fit("G21 G90\nG0 X10 Y0 Z1\nG1 F600\n" + circle(180, "G1 "));
    LONGS_EQUAL(180, fitted.report.moves_in);
    LONGS_EQUAL(1, fitted.report.moves_out);
    LONGS_EQUAL(1, fitted.report.arcs);
    CHECK(fitted.report.max_vertex_deviation_mm <= 0.01);
    CHECK(contains(fitted.text, "G3 X-10 I-"));
}

TEST(FitProgram, KeepsAllOtherWords)
{
    const std::string text = "(part 7)\n%\nG21 G90\nM3 S1000\nG0 X10 Y0\nG1 Z-1 F100\nF600\n" +
                             circle(60, "") + "; a comment\nG4 P0.5\nX0 Y0\nM8\nG0 Z5\nM30\n";
    const FittedProgram fitted = fit(text);
    for (const char* kept : {"(part 7)\n", "%\n", "M3 S1000\n", "G1 Z-1 F100\n", "F600\n",
                             "; a comment\n", "G4 P0.5\n", "M8\n", "G0 Z5\n", "M30\n"}) {
        CHECK_TEXT(contains(fitted.text, kept), kept);
    }
    CHECK(end_of(text) == end_of(fitted.text));
}

TEST(FitProgram, RestoresTheMotionModeForLinesThatRelyOnIt)
{
    const std::string text = "G90 G0 X10 Y0\nG1 F600\n" + circle(60, "") + "M8\nX0 Y0 S5\n";
    const FittedProgram fitted = fit(text);
    CHECK(contains(fitted.text, "G1 X0 Y0 S5\n"));
    CHECK(end_of(text) == end_of(fitted.text));
}

TEST(FitProgram, RestoresThePlane)
{
    std::string text = "G90 G17 G0 X0 Y0 Z10\nG1 F600\n";
    for (int i = 1; i <= 90; ++i) {
        char line[80];
        const double angle = 3.14159265358979 * i / 180;
        (void)std::snprintf(line, sizeof line, "X%.4f Z%.4f\n", 10 * std::sin(angle),
                            10 * std::cos(angle));
        text += line;
    }
    text += "G2 X20 I5\n";
    const FittedProgram fitted = fit(text);
    CHECK(contains(fitted.text, "G18 G3 "));
    CHECK(contains(fitted.text, "G17\nG2 X20 I5\n"));
    CHECK(end_of(text) == end_of(fitted.text));
}

TEST(FitProgram, BreaksRunsWhereTheFeedChanges)
{
    const FittedProgram fitted =
        fit("G90 G0 X10 Y0\nG1 F600\n" + circle(30, "") + "G1 X0 Y0 F300\nX5 Y0 F300\nX10 Y0\n");
    CHECK(contains(fitted.text, "G1 X0 Y0 F300\n"));
    CHECK(contains(fitted.text, "X10"));
    LONGS_EQUAL(3, fitted.report.moves_out);
}

TEST(FitProgram, FitsInchesAndIncrementalPrograms)
{
    const std::string inches =
        "G20 G90\nG0 X0.393701 Y0\nG1 F20\n" + circle(120, "", 25.4) + "G1 X0 Y0\n";
    const FittedProgram fitted = fit(inches);
    LONGS_EQUAL(2, fitted.report.moves_out);
    CHECK(end_of(inches) == end_of(fitted.text));
    std::string incremental = "G21 G91\nG1 F100\n";
    for (int i = 0; i < 100; ++i) {
        char line[80];
        (void)std::snprintf(line, sizeof line, "X0.1 Y%.4f\n", 0.002 * i);
        incremental += line;
    }
    const FittedProgram relative = fit(incremental);
    CHECK(relative.report.moves_out < 12);
    CHECK(end_of(incremental) == end_of(relative.text));
}

TEST(FitProgram, WritesARunInTheModeAndOffsetItWasReadIn)
{
    // M30 goes back to G90 and G54.
    for (const char* mode : {"G91", "G90"}) {
        std::string text =
            "G10 L2 P2 X7 Y8\nG55 G90\nG0 X0 Y0 Z0\n" + std::string{mode} + "\nG1 F100\n";
        for (int i = 0; i < 50; ++i) {
            text += "X0.1" + std::to_string(i) + " Y0." + std::to_string(100 + 7 * i) + "\n";
        }
        text += "M30\n";
        CHECK(end_of(text) == end_of(fit(text).text));
    }
}

TEST(FitProgram, KeepsLineNumbersOfWhatItWrites)
{
    std::string text = "G90 G0 X0 Y0\nG1 F100\n";
    for (int i = 1; i <= 10; ++i) {
        text += "N" + std::to_string(10 * i) + " X" + std::to_string(i) + "\n";
    }
    CHECK(contains(fit(text).text, "N100 G1 X10\n"));
}

TEST(FitProgram, StartsNoRunWhereTheToolIsNotKnownToBe)
{
    const std::string text = "G90 G28\nG1 F100 X1 Y0\nX2 Y0\nX3 Y0\n";
    const FittedProgram fitted = fit(text);
    CHECK(contains(fitted.text, "G1 F100 X1 Y0\nG1 X3\n"));
}

TEST(FitProgram, LeavesInverseTimeAndCurvesAlone)
{
    const std::string text =
        "G93\nG1 X1 Y0 F1\nX2 Y0 F1\nG94 F100\nG5.2 X1 Y1\nX2 Y2\nX3 Y3\nG5.3\n";
    CHECK(text == fit(text).text);
}

TEST(FitProgram, NamesFileAndLineOfWhatItCantUse)
{
    try {
        (void)fit("G21\nG1 X1\n");
        FAIL("not refused");
    } catch (const InputError& error) {
        CHECK(contains(error.what(), "p.ngc:2: error 22"));
    }
}

TEST(FitProgram, MakesFewMovesOfALargePocket)
{
    // 66 686 lines, 390 of them of no length, and 89 rapids.
    const std::string text =
        read_compressed(CUSP_SOURCE_DIR "/tests/programs/pocket-66k-lines.ngc.gz");
    const FittedProgram fitted = fit(text, 0.010);
    LONGS_EQUAL(89, fitted.report.rapids);
    CHECK(fitted.report.moves_out <= 1850);
    CHECK(fitted.report.max_vertex_deviation_mm <= 0.010);
    CHECK(fitted.report.max_deviation_mm <= 0.011);
    CHECK(end_of(text) == end_of(fitted.text));
}

// A quarter of a circle, and a line, over vertices beside them.
TEST(FitProgram, MeasuresHowFarVerticesAndMiddlesAreOff)
{
    const double diagonal = std::sqrt(0.5);
    const std::vector<Position> vertices{
        to_position({10, 0, 0}), to_position({10.05 * diagonal, 10.05 * diagonal, 0}),
        to_position({0, 10, 0}), to_position({-5, 10.02, 0}), to_position({-10, 10, 0})};
    const MeasuredFit arc = measure_fit("G0X10Y0\nG3X0Y10I-10J0F100\n", vertices, {{1, 0, 2}});
    DOUBLES_EQUAL(0.05, arc.vertices, 1e-6);
    const AxisVecd middle = 0.5 * (to_millimetres(vertices[0]) + to_millimetres(vertices[1]));
    DOUBLES_EQUAL(10 - norm(middle), arc.between, 1e-6);
    LONGS_EQUAL(1, arc.arcs);
    const MeasuredFit line = measure_fit("G0X0Y10\nG1X-10Y10F100\n", vertices, {{1, 2, 2}});
    DOUBLES_EQUAL(0.02, line.vertices, 1e-6);
    DOUBLES_EQUAL(0.01, line.between, 1e-6);
}
