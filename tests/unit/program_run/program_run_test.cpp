// Programs in memory, run step by step.
#include "host_tools/controller/program_run/program_run.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/controller/program_run/path_deviation.hpp"
#include "host_tools/controller/program_run/settings_lines.hpp"

namespace {

using namespace cusp;
using program_run::PathDeviation;
using program_run::ProgramRun;
using program_run::RunOptions;
using program_run::RunResult;
using program_run::SetPoint;

}  // namespace

TEST_GROUP(ProgramRun)
{
    RunOptions options;

    RunResult run(const std::string& text) const
    {
        auto source = dialect::LineSource::of_text("part.ngc", text);
        ProgramRun program{source, options};
        while (program.advance()) {
        }
        return program.result();
    }
    std::string refusal(const std::string& text)
    {
        auto source = dialect::LineSource::of_text("mill", text);
        const auto refused = program_run::read_settings(source, options.settings);
        return refused ? std::to_string(refused->line) + ": " + refused->text : std::string{};
    }
};

TEST(ProgramRun, MovesToTheEndOfTheText)
{
    const RunResult result = run("G21 G90\rG1 X1 F600\r\nY2\nM30");
    CHECK(result.good());
    LONGS_EQUAL(4, result.lines);
    LONGS_EQUAL(1'000'000, result.end.x);
    LONGS_EQUAL(2'000'000, result.end.y);
}

TEST(ProgramRun, TellsTheLineOfEverySetPoint)
{
    std::vector<SetPoint> points;
    options.set_point = [&](const SetPoint& point) {
        points.push_back(point);
    };
    const RunResult result = run("G21 G90 G61\n\nG1 X1 F600\n(here)\nX2\n");
    CHECK(points.size() > 200);
    LONGS_EQUAL(0, points.front().line);
    for (std::size_t i = 1; i < points.size(); ++i) {
        CHECK(points[i].microseconds == points[i - 1].microseconds + 1000);
        CHECK(points[i].line >= points[i - 1].line);
        // the line of a set point is the one whose move it lies on, but for what the filters hold back
        if (points[i].at.x > 50'000 && points[i].at.x < 950'000) {
            LONGS_EQUAL(3, points[i].line);
        } else if (points[i].at.x > 1'050'000 && points[i].at.x < 1'950'000) {
            LONGS_EQUAL(5, points[i].line);
        }
    }
    LONGS_EQUAL(2'000'000, points.back().at.x);
    CHECK(result.max_deviation_mm < 0.001);
}

TEST(ProgramRun, DoesNotDependOnWhetherTheDeviationIsMeasured)
{
    const std::string text = "G21 G90 G64 P0.05\nG1 X3 F3000\nG2 X6 I1.5\nG1 Y2\n";
    const RunResult measured = run(text);
    options.measures_deviation = false;
    const RunResult plain = run(text);
    CHECK(measured.max_deviation_mm > 0.0);
    DOUBLES_EQUAL(0.0, plain.max_deviation_mm, 0.0);
    UNSIGNED_LONGS_EQUAL(measured.edges_crc32, plain.edges_crc32);
    CHECK(measured.edges_crc32 != run("G21 G90\nG1 X3 F3000\n").edges_crc32);
}

TEST(ProgramRun, LetsTheDeviationBeMeasuredElsewhere)
{
    options.probe_z = -5.0;
    const std::string text =
        "G21 G90 G64 P0.05\nG1 X3 F3000\nG2 X6 I1.5\nG38.2 Z-9 F300\nG1 X7 F3000\nY2\n";
    const RunResult measured = run(text);
    PathDeviation deviation;
    options.measures_deviation = false;
    options.sums_edges = false;
    options.path = [&](const path::Move* move) {
        if (move != nullptr) {
            deviation.add_move(*move);
        } else {
            deviation.restart();
        }
    };
    options.set_point = [&](const SetPoint& point) {
        if (point.on_path) {
            deviation.add_set_point(point.at);
        }
    };
    const RunResult plain = run(text);
    CHECK(measured.max_deviation_mm > 0.0);
    DOUBLES_EQUAL(measured.max_deviation_mm, deviation.greatest(), 0.0);
    LONGS_EQUAL(measured.max_deviation_line, deviation.line());
    CHECK(measured.edges_crc32 != 0);
    UNSIGNED_LONGS_EQUAL(0, plain.edges_crc32);
}

TEST(ProgramRun, ComesToRestWhereItIsStopped)
{
    auto source =
        dialect::LineSource::of_text("part.ngc", "G21 G91 F600\nG1 X1\nX1\nX1\nX1\nG4 P9\nX50\n");
    ProgramRun program{source, options};
    while (program.advance() && program.seconds() < 0.2) {
    }
    program.stop();
    while (program.advance()) {
    }
    CHECK(program.result().stopped);
    CHECK_FALSE(program.result().good());
    CHECK(program.result().end.x <= 4'000'000);
    CHECK(program.fraction() > 0.5);
}

// The run also acts as the operator: it starts the cycle, and knows the tool's position afterwards.
TEST(ProgramRun, ChangesAndTouchesOffATool)
{
    for (const auto& [number, value] :
         {std::pair{22U, 1.0F}, {25U, 3000.0F}, {341U, 3.0F}, {342U, 60.0F}, {344U, 600.0F}}) {
        CHECK(!options.settings.put(number, value));
    }
    const std::string text =
        "G21 G90\nG10 L2 P9 X-250 Y-150 Z-20\nG0 X-9 Y-9 Z-9\nT1 M6\nG43 H1\nG1 X-12 F3000\n";
    options.probe_z = -30.0;
    const RunResult touched = run(text);
    CHECK(touched.good());
    LONGS_EQUAL(1, touched.pauses);
    CHECK(touched.end == to_position({-12, -9, -9}));
    CHECK(touched.length_mm > 2 * 280);
    // The path to the tool setter is not part of the program's path.
    CHECK(touched.max_deviation_mm < 0.001);
    options.probe_z.reset();
    const RunResult missed = run(text);
    LONGS_EQUAL(5, missed.alarm);
    LONGS_EQUAL(4, missed.errors.at(0).line);
    CHECK(!options.settings.put(22, 0));
    const RunResult lost = run(text);
    STRCMP_EQUAL("error:46: the tool change needs a homed machine: \"T1 M6\"",
                 fault_text(lost, lost.errors.at(0)).c_str());
}

TEST(ProgramRun, SaysWhatEndedIt)
{
    const RunResult refused = run("G21\nG1 X1 F100\nG1 X2 Q\n");
    STRCMP_EQUAL("error:2: a number is missing or malformed: Q in \"G1 X2 Q\"",
                 fault_text(refused, refused.errors.at(0)).c_str());
    LONGS_EQUAL(3, refused.errors[0].line);
    const RunResult joined = run("G21\nN10 Z5 N20 X50\nX3\n");
    STRCMP_EQUAL("error:25: a word is repeated: N20 in \"N10 Z5 N20 X50\"",
                 fault_text(joined, joined.errors.at(0)).c_str());
    const RunResult alarmed = run("G38.2 Z-5 F200\n");
    STRCMP_EQUAL("ALARM:5: alarm: the probe did not touch",
                 fault_text(alarmed, alarmed.errors.at(0)).c_str());
}

TEST(ProgramRun, RefusesSettingsWithTheirLine)
{
    STRCMP_EQUAL("", refusal("$110=1000\n$22=1\n$20=1\n").c_str());
    STRCMP_EQUAL("2: there is no setting $99", refusal("\n$99=1\n").c_str());
    STRCMP_EQUAL("1: '=5' is no setting such as $100=800.000", refusal("=5").c_str());
    STRCMP_EQUAL("1: $100: '0x10' is no number", refusal("$100=0x10").c_str());
    STRCMP_EQUAL("1: $100: '+1' is no number", refusal("$100=+1").c_str());
    STRCMP_EQUAL("1: $110=1e+09 is out of range: 0.001 to 120000", refusal("$110=1e9").c_str());
}
