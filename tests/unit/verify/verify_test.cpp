// Verdicts on paths whose faults are known: a parallel path over a plane and a cylinder's inside,
// then the same path lowered, widened, and with a rapid move through metal.
#include "host_tools/verify/verify.hpp"

#include <cmath>
#include <cstdio>

#include "CppUTest/TestHarness.h"

#include "tests/support/leaks_on_threads.hpp"
#include "tests/unit/import/scratch_folder.hpp"

using namespace cusp;
using namespace cusp::host;

namespace {

const std::string kPlane = R"({"shape": {"type": "surface", "count": 1, "data": [
    {"degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1],
     "knotvector_v": [0, 0, 1, 1], "control_points": {"points":
     [[0, 0, -5], [0, 20, -5], [30, 0, -5], [30, 20, -5]]}}]}})";

const std::string kWall = R"({"shape": {"type": "curve", "count": 1, "data": [
    {"degree": 1, "knotvector": [0, 0, 1, 2, 3, 4, 4], "control_points": {"points":
     [[0, 0], [30, 0], [30, 20], [0, 20], [0, 0]]}}]}})";

const std::string kJob = R"(
[tool]
shape = "ball"
diameter = 6
[cutting]
feed = 1000
[[operation]]
strategy = "parallel_planes"
floor = "plane.json"
step_over = 1
scallop = 0.2
)";

// Passes along x over the whole plane, `step` apart.
std::string passes(double z, double step, double begin = 0, double end = 20)
{
    std::string text = "G21 G90\nG0 Z5\nG0 X0 Y0\n";
    char line[96];
    bool forth = true;
    for (double y = begin; y <= end + 1e-9; y += step) {
        std::snprintf(line, sizeof line, "G1 Y%.4f Z%.4f F1000\nG1 X%d\n", y, z, forth ? 30 : 0);
        text += line;
        forth = !forth;
    }
    return text + "G0 Z5\nM30\n";
}

}  // namespace

TEST_GROUP(Verify)
{
    ScratchFolder folder;
    VerifySettings settings;

    Verification verdict(const std::string& program, const std::string& more = "")
    {
        folder.write("plane.json", kPlane);
        folder.write("wall.json", kWall);
        const Job job = read_job(folder.write("job.toml", kJob + more));
        return verify(job, folder.write("p.ngc", program), settings, [](double) {});
    }
};

TEST(Verify, FindsNoFaultInAGoodPath)
{
    const Verification result = verdict(passes(-5, 1));
    LONGS_EQUAL(0, result.broken.size());
    DOUBLES_EQUAL(0, result.figures.gouge_max, 1e-9);
    DOUBLES_EQUAL(0, *result.figures.ball_gouge_max, 1e-6);
    // ridges between balls of radius 3 that are 1 apart
    const double ridge = 3 - std::sqrt(9 - 0.25);
    DOUBLES_EQUAL(ridge, result.figures.scallop_max, 1e-3);
    DOUBLES_EQUAL(0, result.figures.uncut_share, 0);
    DOUBLES_EQUAL(0, result.figures.rapid_cut_max, 0);
    CHECK(result.figures.cut_depth_max > 0.1 && result.figures.cut_depth_max <= 5);
}

TEST(Verify, MeasuresThePathThatIsTooLow)
{
    const Verification result = verdict(passes(-5.1, 1));
    DOUBLES_EQUAL(0.1, result.figures.gouge_max, 1e-3);
    DOUBLES_EQUAL(0.1, *result.figures.ball_gouge_max, 1e-6);
    CHECK(!result.broken.empty());
}

TEST(Verify, AllowsGougesBelowTheTolerance)
{
    LONGS_EQUAL(0, verdict(passes(-5.01, 1)).broken.size());
}

TEST(Verify, MeasuresTheScallopOfAWidePath)
{
    const Verification result = verdict(passes(-5, 4));
    DOUBLES_EQUAL(3 - std::sqrt(5.0), result.figures.scallop_max, 0.02);
    CHECK(result.figures.uncovered_share > 0.1);
    CHECK(!result.broken.empty());
}

TEST(Verify, FindsTheFloorThatWasNeverCut)
{
    const Verification result = verdict(passes(-5, 1, 0, 10));
    DOUBLES_EQUAL(7.0 / 20, result.figures.uncut_share, 0.02);
    CHECK(!result.broken.empty());
}

TEST(Verify, FindsARapidMoveThroughMetal)
{
    std::string program = passes(-5, 1);
    program.replace(program.find("G0 X0 Y0\n"), 9, "G0 X0 Y0\nG0 Z-2\nG0 X10\nG0 X0\n");
    const Verification result = verdict(program);
    CHECK(result.figures.rapid_cut_max > 0.1);
    CHECK(!result.broken.empty());
}

TEST(Verify, FindsTheToolInAWall)
{
    const std::string wall = "boundary = \"wall.json\"\n";
    const Verification result = verdict(passes(-5, 1), wall);
    DOUBLES_EQUAL(3, *result.figures.wall_gouge_max, 1e-6);
    CHECK(!result.broken.empty());
    std::string inside = "G0 Z5\nG0 X3 Y3\n";
    char line[64];
    for (int k = 0; k <= 14; ++k) {
        std::snprintf(line, sizeof line, "G1 Y%d Z-5 F100\nG1 X%d\n", 3 + k, k % 2 == 0 ? 27 : 3);
        inside += line;
    }
    DOUBLES_EQUAL(0, *verdict(inside, wall).figures.wall_gouge_max, 1e-6);
}

TEST(Verify, RefusesAToolThatTheJobLacks)
{
    STRCMP_CONTAINS("T7 is no tool of the job",
                    refusal([&] { verdict("T7\n" + passes(-5, 1)); }).c_str());
}
