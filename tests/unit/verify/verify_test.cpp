// Verdicts on paths with known faults: a parallel path over a plane and the inside of a cylinder,
// then the same path lowered, widened, and with a rapid move through stock.
#include "host_tools/judge/verify/verify.hpp"

#include <cmath>
#include <cstdio>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::verify;

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

// The same as a job of pockets: a boundary is a wall.
const std::string kPocketJob = R"(
[tool]
shape = "ball"
diameter = 6
[cutting]
feed = 1000
[[operation]]
strategy = "contour_pocket"
floor = "plane.json"
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

// A square pocket of 14 mm, its lower left corner at x, 3.
std::string pocket_at(int x)
{
    char text[400];
    std::snprintf(text, sizeof text,
                  R"({"shape": {"type": "curve", "count": 1, "data": [{"degree": 1,
        "knotvector": [0, 0, 1, 2, 3, 4, 4], "control_points": {"points":
        [[%d, 3], [%d, 3], [%d, 17], [%d, 17], [%d, 3]]}}]}})",
                  x, x + 14, x + 14, x, x);
    return text;
}

// Passes inside such a pocket, the ball of radius 3 along its walls.
std::string pocketed(int x)
{
    std::string text;
    char line[120];
    std::snprintf(line, sizeof line, "G0 Z5\nG0 X%d Y6\n", x + 3);
    text += line;
    for (int y = 6; y <= 14; ++y) {
        std::snprintf(line, sizeof line, "G1 X%d Y%d Z-5 F1000\nG1 X%d\n", x + 3, y, x + 11);
        text += line;
    }
    return text;
}

}  // namespace

TEST_GROUP(Verify)
{
    cusp::test::TemporaryFolder folder;
    VerifySettings settings;

    Verification verdict(const std::string& program, const std::string& more = "")
    {
        folder.with("plane.json", kPlane);
        folder.with("wall.json", kWall);
        const bool walls = more.find("boundary") != std::string::npos;
        const Job job = read_job(folder.with("job.toml", (walls ? kPocketJob : kJob) + more),
                                 cusp::strategies::all());
        return verify::verify(job, folder.with("p.ngc", program), settings, [](double) {});
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

TEST(Verify, TellsWhatEachToolCut)
{
    folder.with("plane.json", kPlane);
    const std::string second = "[[tool]]\nshape = \"flat\"\ndiameter = 8\nnumber = 7\n";
    const Job job = read_job(folder.with("job.toml", "[[tool]]" + kJob.substr(7) + second),
                             cusp::strategies::all());
    // a groove of the flat end 2 mm deep, and one of the ball 4.5 mm deep
    // the job's first tool is used for the moves before the first T word, which cut nothing
    const std::string program =
        "G21 G90\nG0 Z5\nT7\nG0 X5 Y10\nG1 Z-2 F1000\nG1 X25\nG0 Z5\nT1\nG0 X5 Y3\nG1 Z-4.5\n"
        "G1 X20\nG0 Z5\nT7\nG0 X10\nG1 Z4\nG0 Z5\nM30\n";
    const VerifyFigures figures =
        verify::verify(job, folder.with("p.ngc", program), settings, [](double) {}).figures;
    LONGS_EQUAL(2, figures.tools.size());
    const ToolFigures& ball = figures.tools[1];
    const ToolFigures& flat = figures.tools[0];
    LONGS_EQUAL(1, ball.tool.number);
    LONGS_EQUAL(7, flat.tool.number);
    DOUBLES_EQUAL(2, flat.cut_depth_max, 0.01);
    // between the stock that its shank meets and the stock over a position (0.1 mm) further in
    CHECK(ball.cut_depth_max > 4.5 - 3);
    CHECK(ball.cut_depth_max < 4.5 - (3 - std::sqrt(9 - 2.9 * 2.9)));
    DOUBLES_EQUAL(7 + 20 + 1, flat.cut_length, 1e-6);
    DOUBLES_EQUAL(9.5 + 15, ball.cut_length, 1e-6);
    DOUBLES_EQUAL(ball.cut_depth_max, figures.cut_depth_max, 0);
}

TEST(Verify, MeasuresThePathThatIsTooLow)
{
    const Verification result = verdict(passes(-5.1, 1));
    DOUBLES_EQUAL(0.1, result.figures.gouge_max, 1e-3);
    DOUBLES_EQUAL(0.1, *result.figures.ball_gouge_max, 1e-6);
    CHECK(!result.broken.empty());
}

TEST(Verify, MissesNothingWhereNoGroundIsOwed)
{
    const std::string high = passes(-4.5, 1);
    const Verification steep = verdict(high, "slopes = [60, 90]\n");
    LONGS_EQUAL(0, steep.figures.cells);
    LONGS_EQUAL(0, steep.broken.size());
    LONGS_EQUAL(0, verdict(high, "heights = [-4, -1]\n").broken.size());
    DOUBLES_EQUAL(1, verdict(high, "slopes = [0, 60]\n").figures.uncovered_share, 1e-6);
    DOUBLES_EQUAL(1, verdict(high, "heights = [-6, -1]\n").figures.uncovered_share, 1e-6);
}

// With so many points some remain undecided.
TEST(Verify, TellsAProgramThatLeavesMuchEverywhere)
{
    settings.pitch = 0.07;
    const Verification result = verdict(passes(-4.5, 1));
    DOUBLES_EQUAL(1, result.figures.uncovered_share, 1e-6);
    DOUBLES_EQUAL(0.5 + 3 - std::sqrt(9 - 0.25), result.figures.scallop_max, 1e-3);
    LONGS_EQUAL(2, result.broken.size());
}

TEST(Verify, AllowsGougesBelowTheTolerance)
{
    LONGS_EQUAL(0, verdict(passes(-5.01, 1)).broken.size());
}

// A flat end that climbs straight up a plane of slope 1 touches with its rim all along and leaves
// little stock. Then one that goes as deep as it fits into a valley between two such planes: it
// cannot reach the stock over the bottom.
TEST(Verify, KnowsWhereTheRimOfAFlatEndCutsOnASlope)
{
    const auto floor = [](const std::string& along, const std::string& points) {
        return R"({"shape": {"type": "surface", "count": 1, "data": [{"degree_u": 1, "degree_v": 1,
            "size_v": 2, "knotvector_v": [0, 0, 1, 1], )" +
               along + R"(, "control_points": {"points": [)" + points + "]}}]}}";
    };
    const auto judged = [&](const std::string& moves) {
        const Job job = read_job(
            folder.with("job.toml",
                        "[tool]\nshape = \"flat\"\ndiameter = 2\n[cutting]\nfeed = 1000\n"
                        "[[operation]]\nstrategy = \"contour_pocket\"\nfloor = \"floor.json\"\n"
                        "boundary = \"walls.json\"\nscallop = 0.03\n"),
            cusp::strategies::all());
        const std::string program = "G21 G90\nG0 Z5\nG0 X1 Y1\n" + moves + "M30\n";
        return verify::verify(job, folder.with("p.ngc", program), settings, [](double) {}).figures;
    };
    folder.with("walls.json", R"({"shape": {"type": "curve", "count": 1, "data": [{"degree": 1,
        "knotvector": [0, 0, 1, 2, 3, 4, 4], "control_points": {"points":
         [[0, 0], [10, 0], [10, 6], [0, 6], [0, 0]]}}]}})");
    char line[96];
    folder.with("floor.json", floor(R"("size_u": 2, "knotvector_u": [0, 0, 1, 1])",
                                    "[0, 0, -11], [0, 6, -11], [10, 0, -1], [10, 6, -1]"));
    std::string climbs;
    for (int k = 0; k <= 20; ++k) {
        std::snprintf(line, sizeof line, "G0 X1 Y%.1f\nG1 Z-9 F900\nG1 X9 Z-1\nG0 Z5\n",
                      1.0 + 0.2 * k);
        climbs += line;
    }
    const VerifyFigures plane = judged(climbs);
    DOUBLES_EQUAL(0.0, plane.gouge_max, 1e-3);
    // half way between passes the rim is this far above the floor
    CHECK(plane.scallop_max <= (1.0 - std::sqrt(1.0 - 0.1 * 0.1)) * std::sqrt(0.5) + 1e-3);

    folder.with("floor.json", floor(R"("size_u": 3, "knotvector_u": [0, 0, 0.5, 1, 1])",
                                    "[0, 0, -5], [0, 6, -5], [5, 0, -10], [5, 6, -10], "
                                    "[10, 0, -5], [10, 6, -5]"));
    settings.pitch = 5.0 / 27.5;  // one line along the bottom, none at the rim
    std::string along;
    for (int k = 0; k <= 250; ++k) {
        const double x = 1.0 + 0.032 * k;
        const double tip = -9.0 + std::abs(x - 5.0);
        std::snprintf(line, sizeof line, "G0 X%.3f Y1\nG1 Z%.3f F900\nG1 Y5\nG0 Z5\n", x, tip);
        along += line;
    }
    const VerifyFigures furrow = judged(along);
    DOUBLES_EQUAL(0.0, furrow.gouge_max, 1e-3);
    DOUBLES_EQUAL(0.0, furrow.uncovered_share, 0.0);
}

// A slot slightly narrower than the ball between two level sheets. Over the slot's floor the ball
// can only drop between the rims; the height map misses those by half a pitch, and lets it fall
// through. (The floor ends where the ball cannot come from beyond the slot's ends.) Without the
// passes in the middle stock is left.
TEST(Verify, KnowsHowLowABallSinksBetweenTwoRims)
{
    const auto sheet = [](double x0, double x1, double y0, double y1, double z) {
        char text[400];
        std::snprintf(text, sizeof text,
                      R"({"degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
            "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1], "control_points": {
            "points": [[%.2f, %g, %g], [%.2f, %g, %g], [%.2f, %g, %g], [%.2f, %g, %g]]}})",
                      x0, y0, z, x0, y1, z, x1, y0, z, x1, y1, z);
        return std::string{text};
    };
    folder.with("slot.json", R"({"shape": {"type": "surface", "count": 3, "data": [)" +
                                 sheet(0, 3.05, 0, 6, -5) + "," + sheet(3.05, 5.95, 2, 4, -9) +
                                 "," + sheet(5.95, 9, 0, 6, -5) + "]}}");
    const Job job = read_job(
        folder.with("slot.toml",
                    "[tool]\nshape = \"ball\"\ndiameter = 3\n[cutting]\nfeed = 1000\n"
                    "[[operation]]\nstrategy = \"parallel_planes\"\nfloor = \"slot.json\"\n"
                    "step_over = 1\nscallop = 0.02\nfloor_tolerance = 0.001\n"),
        cusp::strategies::all());
    const auto verdict_of = [&](double left_out) {
        std::string text = "G21 G90\nG0 Z5\nG0 X0 Y0\n";
        char line[96];
        for (int k = 0; k <= 180; ++k) {
            const double x = 0.05 * k;
            const double from_rim = 1.45 - std::abs(x - 4.5);
            if (std::abs(x - 4.5) < left_out) {
                continue;
            }
            const double tip = from_rim < 0 ? -5 : -6.5 + std::sqrt(2.25 - from_rim * from_rim);
            std::snprintf(line, sizeof line, "G0 X%.3f Y0\nG1 Z%.5f F900\nG1 Y6\nG0 Z5\n", x, tip);
            text += line;
        }
        return verify::verify(job, folder.with("p.ngc", text + "M30\n"), settings, [](double) {});
    };
    const Verification good = verdict_of(0);
    STRCMP_EQUAL("", good.broken.empty() ? "" : good.broken.front().c_str());
    CHECK(good.figures.scallop_max <= 0.02);
    const Verification bad = verdict_of(0.1);
    CHECK(bad.figures.uncovered_share > 0.01);
    CHECK(!bad.broken.empty());
}

// As on the top face of a CAD part, which lies in the stock's but for rounding.
TEST(Verify, AsksForNoCutWhereOnlyTheScallopStandsAtFirst)
{
    const std::string idle = "G21 G90\nG0 Z5\nG0 X0 Y0\nM30\n";
    LONGS_EQUAL(0, verdict(idle, "[stock]\ntop = -4.9999\n").broken.size());
    CHECK(!verdict(idle, "[stock]\ntop = -4.7\n").broken.empty());
}

// A pass that is raised over 2.5 mm of its length: less than a hundredth of the floor.
TEST(Verify, RefusesOnePlaceThatWasLeftOut)
{
    folder.with("plane.json", kPlane);
    const Job job = read_job(folder.with("job.toml", kJob), cusp::strategies::all());
    std::string program = passes(-5, 2);
    const std::string row = "G1 Y8.0000 Z-5.0000 F1000\nG1 X30\n";
    const std::size_t at = program.find(row);
    CHECK(at != std::string::npos);
    program.replace(at, row.size(), "G1 Y8 Z-5 F1000\nG1 X14\nG1 Z-3\nG1 X16.5\nG1 Z-5\nG1 X30\n");
    const Verification result =
        verify::verify(job, folder.with("p.ngc", program), settings, [](double) {});
    CHECK(result.figures.uncovered_share < 0.01);
    LONGS_EQUAL(1, result.broken.size());
    STRCMP_CONTAINS("left_thickness_mm", result.broken.front().c_str());
    STRCMP_CONTAINS("is over 0.2", result.broken.front().c_str());
    CHECK(result.figures.thickest_left.has_value());
    // the ball came within 1.25 mm of the middle of the omitted part
    DOUBLES_EQUAL(std::sqrt(9 + 1.25 * 1.25) - 3, result.figures.thickest_left->thickness, 0.03);
    DOUBLES_EQUAL(15.25, result.figures.thickest_left->place.x, 0.3);
    DOUBLES_EQUAL(8, result.figures.thickest_left->place.y, 0.8);
    DOUBLES_EQUAL(-5, result.figures.thickest_left->place.z, 0.021);
}

// A path that keeps 0.01 mm farther from a vertical wall than necessary leaves a sliver as high as
// the wall. (The wall extends beyond the floor, else the ball would come from there.)
TEST(Verify, RefusesNoSliverThinnerThanTheTolerance)
{
    const auto level = [](int x0, int x1, int y0, int y1, int z) {
        char text[400];
        std::snprintf(text, sizeof text,
                      R"({"degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
            "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1], "control_points": {
            "points": [[%d, %d, %d], [%d, %d, %d], [%d, %d, %d], [%d, %d, %d]]}})",
                      x0, y0, z, x0, y1, z, x1, y0, z, x1, y1, z);
        return std::string{text};
    };
    folder.with("plane.json", R"({"shape": {"type": "surface", "count": 2, "data": [)" +
                                  level(0, 15, 0, 20, -1) + "," + level(15, 30, 4, 16, -5) + "]}}");
    std::string text = kJob;
    text.replace(text.find("scallop = 0.2"), 13, "scallop = 0.1");
    const Job job = read_job(folder.with("job.toml", text), cusp::strategies::all());
    std::string program = "G21 G90\nG0 Z5\n";
    const auto pass = [&](double x, double z) {
        char line[96];
        std::snprintf(line, sizeof line, "G0 X%.3f Y-3\nG1 Z%.4f F1000\nG1 Y23\nG0 Z5\n", x, z);
        program += line;
    };
    for (int k = 0; k <= 15; ++k) {
        pass(k, -1);
        pass(18.03 + 0.8 * k, -5);
    }
    for (double out = 0.5; out < 3; out += 0.25) {
        pass(15 + out, -4 + std::sqrt(9 - out * out));
    }
    const Verification result =
        verify::verify(job, folder.with("p.ngc", program + "M30\n"), settings, [](double) {});
    // the sliver is 4 mm high and 0.03 mm thick, the columns of heights some tenths apart
    CHECK(result.figures.scallop_max <= 0.1);
    STRCMP_EQUAL("", result.broken.empty() ? "" : result.broken.front().c_str());
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

TEST(Verify, FindsARapidMoveThroughStock)
{
    std::string program = passes(-5, 1);
    program.replace(program.find("G0 X0 Y0\n"), 9, "G0 X0 Y0\nG0 Z-2\nG0 X10\nG0 X0\n");
    const Verification result = verdict(program);
    DOUBLES_EQUAL(2, result.figures.rapid_cut_max, 1e-6);
    LONGS_EQUAL(4, result.figures.rapid_cut_at->line);
    CHECK(!result.broken.empty());
}

// A rapid is measured along its whole way, however it lies and whatever shape the tool has; what it cuts first does
// not hide what it cuts deeper.
TEST(Verify, MeasuresARapidMoveFromItsBeginningToItsEnd)
{
    const struct {
        const char* moves;
        double depth;
        unsigned line;
    } cases[] = {
        {"G0 Z-4.5\n", 4.5, 4},
        {"G0 Z1\nG0 X20 Y10 Z-2\n", 2, 5},
        {"G0 X10 Y10 Z-3\nG0 Z5\n", 3, 4},
        {"G91\nG0 Z-5.5\nG0 Z-1\nG90\n", 1, 6},  // half a millimetre below the top, then one more
        {"G81 X15 Y10 Z-4 R-1.25 F300\nG80\n", 1.25, 4},
        {"G53 G0 X9 Y9 Z-0.75\n", 0.75, 4},
        {"G20\nG0 Z-0.1\nG21\n", 2.54, 5}};
    for (const auto& one : cases) {
        std::string program = passes(-5, 1);
        program.insert(program.find("G0 X0 Y0\n") + 9, std::string{one.moves} + "G0 Z5\n");
        const Verification result = verdict(program);
        DOUBLES_EQUAL(one.depth, result.figures.rapid_cut_max, 2e-3);
        LONGS_EQUAL(one.line, result.figures.rapid_cut_at->line);
    }
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

TEST(Verify, JudgesEachOfSeveralPocketsByItsOwnWalls)
{
    folder.with("left.json", pocket_at(0));
    folder.with("right.json", pocket_at(16));
    const std::string both = "boundary = \"left.json\"\n" +
                             kPocketJob.substr(kPocketJob.find("[[operation]]")) +
                             "boundary = \"right.json\"\n";
    const std::string good = "G21 G90\n" + pocketed(0) + pocketed(16) + "G0 Z5\nM30\n";
    const Verification result = verdict(good, both);
    LONGS_EQUAL(0, result.broken.size());
    DOUBLES_EQUAL(0, *result.figures.wall_gouge_max, 1e-9);
    CHECK(result.figures.cells > 500);

    // the second pocket is left out
    const Verification half = verdict("G21 G90\n" + pocketed(0) + "G0 Z5\nM30\n", both);
    CHECK(half.figures.uncovered_share > 0.3);
    CHECK(half.figures.uncovered_at->place.x > 16);
    CHECK(half.broken.front().find(" at x ") != std::string::npos);

    // through the web of 2 mm between them, whose middle is 1 mm from either
    const Verification through =
        verdict("G21 G90\n" + pocketed(0) + "G1 X27\n" + pocketed(16) + "G0 Z5\nM30\n", both);
    DOUBLES_EQUAL(3 + 1, *through.figures.wall_gouge_max, 0.05);
}

TEST(Verify, WallsOfOnePocketBindNoToolOfAnOperationWithoutBoundary)
{
    folder.with("left.json", pocket_at(0));
    folder.with("right.json", pocket_at(16));
    const std::string rough =
        "boundary = \"left.json\"\n[[operation]]\nstrategy = \"hull_rough\"\nfloor = "
        "\"plane.json\"\n"
        "max_depth = 2\n";
    const std::string second = "tool = 2\n[[tool]]\nshape = \"flat\"\ndiameter = 6\n";
    const std::string pocket = "G21 G90\nT1\n" + pocketed(0);
    const std::string beyond = pocket + "G1 X27\nG0 Z5\nM30\n";
    DOUBLES_EQUAL(0, *verdict(beyond, rough).figures.wall_gouge_max, 1e-9);
    const auto judged = [&](const std::string& program) {
        const Job job =
            read_job(folder.with("job.toml", "[[tool]]" + kPocketJob.substr(7) + rough + second),
                     cusp::strategies::all());
        return *verify::verify(job, folder.with("p.ngc", program), settings, [](double) {
                }).figures.wall_gouge_max;
    };
    CHECK(judged(beyond) > 6);
    DOUBLES_EQUAL(0, judged(pocket + "G0 Z5\nT2\nG0 X25 Y8\nG1 Z-2\nG0 Z5\nM30\n"), 1e-9);
}

TEST(Verify, RefusesAToolThatTheJobLacks)
{
    STRCMP_CONTAINS("T7 is no tool of the job",
                    cusp::test::refusal([&] { verdict("T7\n" + passes(-5, 1)); }).c_str());
}
