// Whole programs through the whole firmware, judged by invariants.
#include "host_tools/controller/simulate/simulate.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"
#include "tests/judges/edge_crc.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace cusp;

const std::string kPrograms = CUSP_SOURCE_DIR "/tests/programs/";

struct Step {
    std::int64_t time_us;
    unsigned axis;
    int sign;
};

// Rising edges of the step wires of a dump, as any reader of VCD finds them.
std::vector<Step> steps_of(const std::string& vcd)
{
    std::istringstream in{vcd};
    std::string line;
    std::vector<Step> steps;
    std::array<bool, 6> levels{};
    std::int64_t time = 0;
    bool dumping = true;
    while (std::getline(in, line)) {
        if (line[0] == '#') {
            time = std::stoll(line.substr(1));
        } else if (line == "$end") {
            dumping = false;
        } else if (line.size() == 2 && line[1] >= '!' && line[1] < '!' + 6) {
            const auto wire = static_cast<unsigned>(line[1] - '!');
            levels[wire] = line[0] == '1';
            if (!dumping && wire % 2 == 0 && levels[wire]) {
                steps.push_back({time, wire / 2, levels[wire + 1] ? 1 : -1});
            }
        }
    }
    return steps;
}

// CRC-32 of the edges of the six lines of a dump, in its order.
std::uint32_t crc_of(const std::string& vcd)
{
    std::istringstream in{vcd.substr(vcd.find("$dumpvars"))};
    std::string line;
    test::PlainCrc32 crc;
    std::uint64_t time = 0;
    bool dumping = true;
    while (std::getline(in, line)) {
        if (line[0] == '#') {
            time = std::stoull(line.substr(1));
        } else if (line == "$end") {
            dumping = false;
        } else if (!dumping && line[1] < '!' + 6) {
            crc.add_edge(time, static_cast<unsigned>(line[1] - '!'), line[0] == '1');
        }
    }
    return crc.value();
}

struct Sample {
    std::int64_t time_us;
    std::array<double, 3> mm;
};

std::vector<Sample> samples_of(const std::string& csv)
{
    std::istringstream in{csv};
    std::string line;
    std::getline(in, line);
    std::vector<Sample> samples;
    while (std::getline(in, line)) {
        long long t = 0;
        std::array<double, 3> nm{};
        std::sscanf(line.c_str(), "%lld,%lf,%lf,%lf", &t, &nm[0], &nm[1], &nm[2]);
        samples.push_back({t, {nm[0] * 1e-6, nm[1] * 1e-6, nm[2] * 1e-6}});
    }
    return samples;
}

}  // namespace

TEST_GROUP(Simulation)
{
    test::TemporaryFolder folder;
    simulate::SimulationOptions options;

    simulate::SimulationResult run(const std::string& text)
    {
        return simulate::simulate(folder.with("part.ngc", text), options);
    }
    void set(std::uint32_t number, float value)
    {
        CHECK_FALSE(options.settings.put(number, value).has_value());
    }
    void check_limits(const simulate::SimulationResult& result) const
    {
        const MachineLimits limits = options.settings.limits();
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            // Whole nanometres round differences by 1, 2 and 4 nm.
            CHECK(result.max_velocity[axis] <= static_cast<double>(limits.velocity[axis]) + 1e-3);
            CHECK(result.max_acceleration[axis] <=
                  static_cast<double>(limits.acceleration[axis]) + 2.0);
            CHECK(result.max_jerk[axis] <= static_cast<double>(limits.jerk[axis]) + 4000.0);
        }
    }
};

TEST(Simulation, EndsWithAnErrorWhereTheControllerIsResetAtRest)
{
    options.script = {{100, '!'}, {900, 0x18}};
    const simulate::SimulationResult result = run("G21G90\nG1X50F1000\nX0\n");
    CHECK_FALSE(result.good());
    STRCMP_EQUAL("the controller was reset", result.errors.at(0).text.c_str());
}

TEST(Simulation, RunsThePlainProgramsWithinEveryLimit)
{
    for (const char* name : {"line", "diag", "square", "rsq", "circle"}) {
        const simulate::SimulationResult result =
            simulate::simulate(kPrograms + name + ".ngc", options);
        CHECK(result.good());
        CHECK(result.max_deviation_mm <= 0.0101);
        LONGS_EQUAL(0, result.starved_ticks);
        check_limits(result);
    }
}

TEST(Simulation, CountsMovesStepsAndLines)
{
    const simulate::SimulationResult result =
        run("G21 G90 G17 G64\nG0 X10\nG1 Y5 F1000\nG2 X15 Y10 I5\nG5.2 X20 Y10 L3\nX20 Y20\nX30 "
            "Y20\nG5.3\nM30\nG0 X99\n");
    CHECK(result.good());
    LONGS_EQUAL(1, result.moves.rapid);
    LONGS_EQUAL(1, result.moves.line);
    LONGS_EQUAL(1, result.moves.arc);
    LONGS_EQUAL(1, result.moves.nurbs);
    LONGS_EQUAL(9, result.lines);
    LONGS_EQUAL(30'000'000, result.end.x);
    LONGS_EQUAL(20'000'000, result.end.y);
    LONGS_EQUAL(0, result.steps[2]);
    CHECK(result.steps[0] >= 30U * 800U);
}

TEST(Simulation, WritesAStepWhereThePathCrossesHalfAStep)
{
    options.vcd_file = folder.file("t.vcd");
    options.samples_file = folder.file("t.csv");
    CHECK(simulate::simulate(kPrograms + "rsq.ngc", options).good());
    const auto samples = samples_of(folder.text_of("t.csv"));
    const auto steps = steps_of(folder.text_of("t.vcd"));
    CHECK(steps.size() > 100'000);
    std::array<long, 3> count{};
    double worst = 0.0;
    for (const Step& step : steps) {
        const double half = static_cast<double>(count[step.axis]) + 0.5 * step.sign;
        count[step.axis] += step.sign;
        const auto k = static_cast<std::size_t>((step.time_us - samples[0].time_us) / 1000);
        if (k + 1 >= samples.size() || step.time_us < samples[0].time_us) {
            continue;
        }
        const double part = static_cast<double>(step.time_us - samples[k].time_us) / 1000.0;
        const double place =
            samples[k].mm[step.axis] * (1.0 - part) + samples[k + 1].mm[step.axis] * part;
        worst = std::max(worst, std::fabs(place * 800.0 - half));
    }
    // A step is 1.25 um; a chord of one tick leaves the path by 0.13 um, 5 us of set-up by 0.5 um.
    CHECK(worst < 0.6);
    LONGS_EQUAL(0, count[0]);
    LONGS_EQUAL(0, count[1]);
}

TEST(Simulation, RepeatsBitForBit)
{
    options.vcd_file = folder.file("a.vcd");
    simulate::simulate(kPrograms + "circle.ngc", options);
    options.vcd_file = folder.file("b.vcd");
    simulate::simulate(kPrograms + "circle.ngc", options);
    CHECK(folder.text_of("a.vcd") == folder.text_of("b.vcd"));
}

TEST(Simulation, SumsUpTheEdgesOfTheTrace)
{
    options.vcd_file = folder.file("t.vcd");
    for (const char* name : {"rsq", "circle", "diag"}) {
        const auto result = simulate::simulate(kPrograms + name + ".ngc", options);
        UNSIGNED_LONGS_EQUAL(crc_of(folder.text_of("t.vcd")), result.edges_crc32);
    }
    set(22, 1);
    set(25, 3000);
    const auto homed = run("G21 G90\nM3 S500\nG1 X-20 Y-3 F1000\nM8\nG1 Z-5\n");
    UNSIGNED_LONGS_EQUAL(crc_of(folder.text_of("t.vcd")), homed.edges_crc32);
    CHECK(statistics_json(homed).find("\"edges_crc32\": \"") != std::string::npos);
}

TEST(Simulation, EndsAtTheFirstError)
{
    options.samples_file = folder.file("t.csv");
    const simulate::SimulationResult result = run("G21\nG1 X1 F100\nG1 X2 Q\nG1 X3\n");
    CHECK_FALSE(result.good());
    LONGS_EQUAL(1, result.errors.size());
    LONGS_EQUAL(3, result.errors[0].line);
    LONGS_EQUAL(2, result.errors[0].code);
    LONGS_EQUAL(1'000'000, result.end.x);
    CHECK(samples_of(folder.text_of("t.csv")).size() > 600);
    CHECK(simulate::statistics_json(result).find("\"code\": 2") != std::string::npos);
}

TEST(Simulation, EndsInAlarmFiveWhereTheProbeFindsNothing)
{
    LONGS_EQUAL(5, run("G21 G38.2 Z-5 F200\n").alarm);
    options.probe_z = -2.0;
    const simulate::SimulationResult result = run("G21 G38.2 Z-5 F200\nG0 Z0\n");
    CHECK(result.good());
    LONGS_EQUAL(0, result.end.z);
}

TEST(Simulation, GoesOnAfterPausesAndListsThem)
{
    const simulate::SimulationResult result = run("G1 X1 F600\nM0\nG1 X2\nT2 M6\nG1 X3\nM30\n");
    CHECK(result.good());
    LONGS_EQUAL(2, result.pause_lines.size());
    LONGS_EQUAL(2, result.pause_lines[0]);
    LONGS_EQUAL(4, result.pause_lines[1]);
    LONGS_EQUAL(3'000'000, result.end.x);
}

TEST(Simulation, CountsTheTimeOfEachTool)
{
    const simulate::SimulationResult result =
        run("G21 G90\nT1\nG1 X10 F600\nM0\nT2\nG1 X30\nM30\n");
    LONGS_EQUAL(1, result.tool_changes);
    LONGS_EQUAL(2, result.tools.size());
    LONGS_EQUAL(1, result.tools[0].number);
    LONGS_EQUAL(2, result.tools[1].number);
    // 10 mm and 20 mm at 10 mm/s, and a few hundredths to get up to speed
    DOUBLES_EQUAL(1.05, result.tools[0].seconds(), 0.05);
    DOUBLES_EQUAL(2.05, result.tools[1].seconds(), 0.05);
}

TEST(Simulation, TakesItsTimeForADwell)
{
    const simulate::SimulationResult result = run("G1 X1 F600\nG4 P2\nG1 X2\n");
    CHECK(result.duration_s > 2.1);
    CHECK(result.duration_s < 2.6);
}

TEST(Simulation, HomesFirstWhereHomingIsOn)
{
    set(22, 1);
    set(20, 1);
    set(25, 3000);
    const simulate::SimulationResult inside = run("G21 G90\nG1 X-20 Y-20 Z-20 F1000\n");
    CHECK(inside.good());
    const simulate::SimulationResult outside = run("G21 G90\nG1 X20 F1000\n");
    LONGS_EQUAL(2, outside.alarm);
}

TEST(Simulation, RefusesFilesThatAreNotThere)
{
    CHECK_THROWS(InputError, simulate::simulate(folder.file("none.ngc"), options));
    options.vcd_file = folder.file("no/such/place.vcd");
    CHECK_THROWS(InputError, run("M2\n"));
}

TEST(Simulation, CallsAnOpenNurbsAtTheEndAnError)
{
    const simulate::SimulationResult result = run("G21 F500\nG5.2 X1 Y1 L3\nX2 Y0\n");
    LONGS_EQUAL(33, result.errors.at(0).code);
}

TEST(Simulation, OfAnEmptyProgramIsDoneAtOnce)
{
    const simulate::SimulationResult result = run("%\n(nothing)\n%\n");
    CHECK(result.good());
    DOUBLES_EQUAL(0.0, result.duration_s, 0.0);
}
