// Job files: every key, its default, its range.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"
#include "tests/support/example_parts.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::test;

namespace {

const std::string kHead = R"(units = "mm"
[tool]
number = 3
shape = "ball"
diameter = 12.0
[cutting]
feed = 1200.0
plunge_feed = 300
spindle = 12000
[stock]
top = 0.0
clearance = 5.0
)";

std::string pocket(const std::string& more = "")
{
    return "[[operation]]\nstrategy = \"contour_pocket\"\nfloor = [\"" + kExampleParts +
           "suh-lee-floor.json\"]\nboundary = \"" + kExampleParts +
           "suh-lee-boundary.json\"\nislands = [\"" + kExampleParts + "suh-lee-island.json\"]\n" +
           (more.find("scallop") == std::string::npos ? "scallop = 0.4\n" : "") + more;
}

}  // namespace

TEST_GROUP(JobReader)
{
    cusp::test::TemporaryFolder folder;

    Job read(const std::string& text)
    {
        return read_job(folder.with("job.toml", text), cusp::strategies::all());
    }
    std::string refused(const std::string& text)
    {
        return cusp::test::refusal([&] { read(text); });
    }
    // The head with one piece of text replaced.
    std::string refused_head(const std::string& from, const std::string& to)
    {
        std::string head = kHead;
        head.replace(head.find(from), from.size(), to);
        return refused(head + pocket());
    }
};

TEST(JobReader, IsocurvesAndPlanesTakeAMeshItselfOtherStrategiesTheSurfacesOverIt)
{
    folder.with("plate.stl",
                "solid p\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 10 0 0\n"
                "vertex 0 10 0\nendloop\nendfacet\nendsolid p\n");
    const auto operation = [&](const std::string& strategy) {
        return read(kHead + "[[operation]]\nstrategy = \"" + strategy +
                    "\"\nfloor = \"plate.stl\"\nscallop = 0.4\n")
            .operations.front();
    };
    LONGS_EQUAL(1, operation("adaptive_isocurve").part.mesh.size());
    LONGS_EQUAL(0, operation("adaptive_isocurve").part.floor.size());
    LONGS_EQUAL(1, operation("parallel_planes").part.mesh.size());
    LONGS_EQUAL(0, operation("complete_isocurves").part.mesh.size());
    LONGS_EQUAL(1, operation("complete_isocurves").part.floor.size());
}

TEST(JobReader, IntersectsTheFloor)
{
    const std::string hills =
        "[[operation]]\nstrategy = \"adaptive_isocurve\"\nscallop = 0.4\n"
        "floor = [\"" +
        kExampleParts + "sine-hills.json\"]\n";
    const Operation whole = read(kHead + hills).operations[0];
    const Operation cut =
        read(kHead + hills + "intersect = \"" + kExampleParts + "dome-lid.json\"\n").operations[0];
    CHECK(whole.part.intersect_files.empty());
    LONGS_EQUAL(1, cut.part.intersect_files.size());
    // the lid comes last, and something is cut off it
    CHECK(!cut.part.floor.back().trims.empty());
    LONGS_EQUAL(2, cut.part.floor.back().degree_u);
    const auto is_trimmed = [](const Surface& s) {
        return !s.trims.empty();
    };
    CHECK(std::count_if(cut.part.floor.begin(), cut.part.floor.end(), is_trimmed) >
          std::count_if(whole.part.floor.begin(), whole.part.floor.end(), is_trimmed));
}

TEST(JobReader, RefusesAnIntersectionThatLeavesNothing)
{
    folder.with("apart.json",
                R"({"shape": {"type": "surface", "count": 1, "data": [{"degree_u": 1, "degree_v": 1,
        "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
        "control_points": {"points": [[900, 0, 0], [900, 9, 0], [909, 0, 0], [909, 9, 0]]}}]}})");
    const std::string text = refused(kHead + pocket("intersect = [\"apart.json\"]\n"));
    STRCMP_CONTAINS("operation 1", text.c_str());
    STRCMP_CONTAINS("intersect: leaves nothing of the floor", text.c_str());
    STRCMP_CONTAINS("missing.json",
                    refused(kHead + pocket("intersect = [\"missing.json\"]\n")).c_str());
}

TEST(JobReader, ReadsTheDemo)
{
    const Job job = read(kHead + pocket("floor_tolerance = 0.01\noutput = \"arcs\"\n"));
    LONGS_EQUAL(3, job.tools[0].number);
    DOUBLES_EQUAL(6.0, job.tools[0].radius, 0);
    DOUBLES_EQUAL(6.0, job.tools[0].corner_radius, 0);
    DOUBLES_EQUAL(1200, job.feed, 0);
    const Operation& operation = job.operations.at(0);
    STRCMP_EQUAL("contour_pocket", operation.name().c_str());
    LONGS_EQUAL(1, operation.part.floor.size());
    LONGS_EQUAL(1, operation.outline.islands.size());
    DOUBLES_EQUAL(0.4, *operation.tolerance.scallop, 0);
    DOUBLES_EQUAL(0.01, operation.tolerance.floor, 0);
    CHECK(operation.output == OutputForm::kArcs);
    CHECK(operation.tolerance.side == ToleranceSide::kOutside);
    LONGS_EQUAL(3, operation.tool.number);
}

TEST(JobReader, TurnsInchesIntoMillimetresEverywhere)
{
    const std::string text =
        "units = \"inch\"\n[tool]\nshape = \"bull\"\ndiameter = 0.25\n"
        "corner_radius = 0.05\n[cutting]\nfeed = 20\nplunge_feed = 5\n"
        "spindle = 8000\n[stock]\ntop = 0.5\nclearance = 0.2\nbottom = -2\n"
        "x = [0, 4]\ny = [-1, 4]\n[[operation]]\nstrategy = \"grid_pocket\"\n"
        "floor = \"" +
        kExampleParts + "choi-polygon-floor.json\"\nboundary = \"" + kExampleParts +
        "choi-polygon-boundary.json\"\ngrid = [0.125, 0.0625]\n"
        "max_arc_radius = 10\nzigzag = [\"x\", \"y\"]\nlayers = [0.25, 1]\n"
        "max_depth = 0.5\nallowance = 0.01\n";
    const Job job = read(text);
    CHECK(job.inch);
    DOUBLES_EQUAL(3.175, job.tools[0].radius, 1e-12);
    DOUBLES_EQUAL(1.27, job.tools[0].corner_radius, 1e-12);
    DOUBLES_EQUAL(508, job.feed, 1e-9);
    DOUBLES_EQUAL(127, job.plunge_feed, 1e-9);
    DOUBLES_EQUAL(8000, job.spindle, 0);
    DOUBLES_EQUAL(12.7, job.stock_top, 1e-12);
    DOUBLES_EQUAL(5.08, job.clearance, 1e-12);
    DOUBLES_EQUAL(-50.8, *job.stock_bottom, 1e-12);
    DOUBLES_EQUAL(101.6, (*job.stock_x)[1], 1e-12);
    DOUBLES_EQUAL(-25.4, (*job.stock_y)[0], 1e-12);
    const Operation& operation = job.operations.at(0);
    DOUBLES_EQUAL(3.175, cusp::grid_pocket::grid_keys(operation).grid_x, 1e-12);
    DOUBLES_EQUAL(1.5875, cusp::grid_pocket::grid_keys(operation).grid_y, 1e-12);
    DOUBLES_EQUAL(254, cusp::grid_pocket::grid_keys(operation).max_arc_radius, 1e-9);
    DOUBLES_EQUAL(25.4, operation.levels.layers[1], 1e-9);
    DOUBLES_EQUAL(12.7, *operation.levels.max_depth, 1e-9);
    DOUBLES_EQUAL(0.254, operation.passes.allowance, 1e-9);
    DOUBLES_EQUAL(0.02, operation.tolerance.floor, 0);
    LONGS_EQUAL('y', cusp::grid_pocket::grid_keys(operation).zigzag[1]);
    DOUBLES_EQUAL(2.5 * 25.4, (*operation.outline.boundary)[0].points.back().x, 1e-9);
}

TEST(JobReader, ReadsTheChoiceOfTools)
{
    const std::string text =
        "[[tool]]\nnumber = 1\nshape = \"flat\"\ndiameter = 20\n[[tool]]\nnumber = 2\n"
        "shape = \"flat\"\ndiameter = 12\n[cutting]\nfeed = 1000\n[[operation]]\n"
        "strategy = \"hull_rough\"\nfloor = [\"" +
        kExampleParts +
        "chuang-pan-tap.json\"]\nmax_depth = 2\nmin_depth = 1\ntools = [1, 2]\ntool = 2\n";
    const Operation operation = read(text).operations.at(0);
    LONGS_EQUAL(2, operation.tools.size());
    DOUBLES_EQUAL(6, operation.tool.radius, 0);
    DOUBLES_EQUAL(0, operation.tool.corner_radius, 0);
}

TEST(JobReader, RefusesAChoiceOfToolsThatIsEmptyBrokenOrDouble)
{
    const auto choice = [&](const std::string& tools) {
        return refused(kHead + "[[operation]]\nstrategy = \"hull_rough\"\nfloor = [\"" +
                       kExampleParts + "chuang-pan-tap.json\"]\nmax_depth = 2\ntools = " + tools +
                       "\n");
    };
    STRCMP_CONTAINS("tools: names no tool", choice("[]").c_str());
    STRCMP_CONTAINS("tools: holds 1.5, whole numbers are needed", choice("[1.5]").c_str());
    STRCMP_CONTAINS("tools: holds tool 3 twice", choice("[3, 3]").c_str());
    STRCMP_CONTAINS("tools: is 7, no [[tool]] has that number", choice("[3, 7]").c_str());
    STRCMP_CONTAINS("tools: is \"1\", but no tool has a name", choice("\"1\"").c_str());
    STRCMP_CONTAINS("tools: a list of numbers is needed", choice("1").c_str());
}

TEST(JobReader, RefusesALeastDepthThatNoLayerCanHave)
{
    const std::string none = refused(kHead + pocket("scallop = 0.4\nmin_depth = 1\n"));
    STRCMP_CONTAINS("min_depth: needs max_depth or layers", none.c_str());
    STRCMP_CONTAINS("job.toml:19", none.c_str());
    STRCMP_CONTAINS(
        "layers: the layer down to 3.5 mm is 0.5 mm deep, less than the min_depth of 1 mm",
        refused(kHead + pocket("min_depth = 1\nlayers = [3, 3.5]\n")).c_str());
}

TEST(JobReader, RefusesRoughingThatAPocketWouldPassOver)
{
    const auto refusal = [&](const std::string& more) {
        const std::string tools = "[[tool]]\nnumber = 4\nshape = \"flat\"\ndiameter = 9\n";
        std::string head = kHead;
        head.replace(head.find("[tool]"), 6, "[[tool]]");
        return refused(head + tools + pocket("scallop = 0.4\n" + more));
    };
    STRCMP_CONTAINS("job.toml:23: operation 1: allowance: needs max_depth or layers",
                    refusal("allowance = 0.3\n").c_str());
    STRCMP_CONTAINS("tools: tool 4 needs max_depth or layers", refusal("tools = [4, 3]\n").c_str());
    STRCMP_CONTAINS("tools: the first may rough, tool 3 finishes",
                    refusal("tools = [3, 4]\nmax_depth = 2\n").c_str());
    STRCMP_EQUAL("", refusal("tools = [4, 3]\nmax_depth = 2\nallowance = 0.3\n").c_str());
    STRCMP_EQUAL("", refusal("tools = [4]\nlayers = [3]\n").c_str());
}

TEST(JobReader, RefusesWhatAdaptiveClearingDoesNotKnow)
{
    const auto refusal = [&](const std::string& more) {
        std::string head = kHead;
        head.replace(head.find("[tool]"), 6, "[[tool]]");
        return refused(head + "[[tool]]\nnumber = 4\nshape = \"flat\"\ndiameter = 9\n" +
                       pocket("scallop = 0.4\n" + more));
    };
    const std::string adaptive = "clearing = \"adaptive\"\n";
    STRCMP_CONTAINS("clearing: \"adaptive\" needs max_depth or layers: the floor is not level",
                    refusal(adaptive + "tool = 4\n").c_str());
    STRCMP_EQUAL("", refusal(adaptive + "tool = 4\nmax_depth = 2\nallowance = 0.3\n").c_str());
    STRCMP_CONTAINS("max_engagement: ",
                    refusal(adaptive + "tool = 4\nmax_engagement = 10\n").c_str());
    STRCMP_CONTAINS("max_engagement: needs clearing", refusal("max_engagement = 60\n").c_str());
    STRCMP_CONTAINS("clearing: ", refusal("clearing = \"zigzag\"\n").c_str());
}

TEST(JobReader, RefusesAnUnknownKeyAndNamesTheNearest)
{
    const std::string text = refused(kHead + pocket("scalop = 0.4\nscallop = 0.4\n"));
    STRCMP_CONTAINS("scalop: unknown key; the nearest known one is scallop", text.c_str());
    STRCMP_CONTAINS("job.toml:18", text.c_str());
    STRCMP_CONTAINS("nearest known one is feed",
                    refused_head("feed = 1200.0", "feed = 1\nfed = 2").c_str());
    STRCMP_CONTAINS("nearest known one is units",
                    refused_head("units = \"mm\"", "unit = \"mm\"").c_str());
}

TEST(JobReader, RefusesAKeyOfAnotherStrategyWithItsPlace)
{
    const std::string text = refused(kHead + pocket("scallop = 0.4\ngrid = [1, 1]\n"));
    STRCMP_CONTAINS("grid: is a key of grid_pocket, not of contour_pocket", text.c_str());
    STRCMP_CONTAINS("job.toml:19", text.c_str());
    STRCMP_CONTAINS("step_over: is a key of parallel_planes",
                    refused(kHead + pocket("scallop = 0.4\nstep_over = 2\n")).c_str());
}

TEST(JobReader, NamesATypoBeforeTheKeyThatItMakesMissing)
{
    STRCMP_CONTAINS("job.toml:7: cutting: feedrate: unknown key; the nearest known one is feed",
                    refused_head("feed = 1200.0", "feedrate = 1200").c_str());
    STRCMP_CONTAINS("cuting: unknown key; the nearest known one is cutting",
                    refused_head("[cutting]", "[cuting]").c_str());
    STRCMP_CONTAINS("strategi: unknown key",
                    refused(kHead + "[[operation]]\nstrategi = \"contour_pocket\"\n").c_str());
}

TEST(JobReader, RefusesIsoSpacingWhereNoStrategyTakesIt)
{
    const std::string key = "iso_spacing = \"even\"\n";
    STRCMP_CONTAINS("iso_spacing: is a key of adaptive_isocurve, not of contour_pocket",
                    refused(kHead + pocket(key)).c_str());
    STRCMP_CONTAINS("not of complete_isocurves",
                    refused(kHead + "[[operation]]\nstrategy = \"complete_isocurves\"\n" +
                            "iso_distance = 1\n" + key)
                        .c_str());
}

TEST(JobReader, TakesThePartsTopForAStockWithoutOne)
{
    folder.with("ramp.stl",
                "solid p\nfacet normal 0 0 1\nouter loop\nvertex 0 0 -3\nvertex 10 0 7.5\n"
                "vertex 0 10 -3\nendloop\nendfacet\nendsolid p\n");
    std::string head = kHead;
    head.erase(head.find("top = 0.0\n"), 10);
    const std::string finish =
        "[[operation]]\nstrategy = \"adaptive_isocurve\"\nfloor = \"ramp.stl\"\nscallop = 0.4\n";
    const Job over = read(head + finish);
    DOUBLES_EQUAL(7.5, over.stock_top, 1e-12);
    DOUBLES_EQUAL(7.5, *over.part_top, 1e-12);
    DOUBLES_EQUAL(0, read(kHead + finish).stock_top, 0);
    folder.with("low.stl",
                "solid p\nfacet normal 0 0 1\nouter loop\nvertex 0 0 -3\nvertex 10 0 -2\n"
                "vertex 0 10 -3\nendloop\nendfacet\nendsolid p\n");
    std::string low = finish;
    low.replace(low.find("ramp.stl"), 8, "low.stl");
    DOUBLES_EQUAL(0, read(head + low).stock_top, 0);
    STRCMP_CONTAINS("stock: bottom: is 8 mm, not below the top at 7.5 mm, the part's",
                    refused(head + "bottom = 8\n" + finish).c_str());
    const Job in_pocket = read(head + pocket());  // its floor lies below 0
    DOUBLES_EQUAL(0, in_pocket.stock_top, 0);
    CHECK(!in_pocket.part_top);
}

TEST(JobReader, RefusesBrokenTomlWithItsLine)
{
    STRCMP_CONTAINS("job.toml:2: not TOML", refused("units = \"mm\"\n[tool\n").c_str());
}

TEST(JobReader, RefusesAMissingJob)
{
    STRCMP_CONTAINS("No such file", cusp::test::refusal([&] {
                                        read_job(folder.file("none.toml"), cusp::strategies::all());
                                    }).c_str());
}

TEST(JobReader, RefusesNumbersOutOfRange)
{
    STRCMP_CONTAINS("job.toml:5: tool 1: diameter: is -1, it must be above 0",
                    refused_head("diameter = 12.0", "diameter = -1").c_str());
    STRCMP_CONTAINS("feed: is 0", refused_head("feed = 1200.0", "feed = 0").c_str());
    STRCMP_CONTAINS("feed: is 1e-09, it must be at least 0.01",
                    refused_head("feed = 1200.0", "feed = 1e-9").c_str());
    STRCMP_CONTAINS("clearance: is -5", refused_head("clearance = 5.0", "clearance = -5").c_str());
    STRCMP_CONTAINS("top: is nan", refused_head("top = 0.0", "top = nan").c_str());
    STRCMP_CONTAINS("feed: is inf", refused_head("feed = 1200.0", "feed = inf").c_str());
    STRCMP_CONTAINS("number: is 1.5", refused_head("number = 3", "number = 1.5").c_str());
}

TEST(JobReader, RefusesValuesOfAnotherKind)
{
    STRCMP_CONTAINS("a number is needed", refused_head("12.0", "\"twelve\"").c_str());
    STRCMP_CONTAINS("in quotes", refused_head("shape = \"ball\"", "shape = 3").c_str());
    STRCMP_CONTAINS("known are \"ball\", \"flat\", \"bull\"",
                    refused_head("\"ball\"", "\"cone\"").c_str());
    STRCMP_CONTAINS("list of numbers", refused(kHead + pocket("layers = 3\n")).c_str());
    STRCMP_CONTAINS("true or false", refused(kHead + pocket("chip_load = 1\n")).c_str());
}

TEST(JobReader, RefusesAKeyOfAnotherStrategyBeforeItsValue)
{
    STRCMP_CONTAINS("roughing: is a key of adaptive_isocurve",
                    refused(kHead + pocket("roughing = 1\n")).c_str());
}

TEST(JobReader, RefusesABullToolWithoutOrWithTooLargeACorner)
{
    STRCMP_CONTAINS("corner_radius: is missing", refused_head("\"ball\"", "\"bull\"").c_str());
    STRCMP_CONTAINS("radius is only 6 mm",
                    refused_head("\"ball\"", "\"bull\"\ncorner_radius = 7").c_str());
}

TEST(JobReader, RefusesAScallopBelowItsTolerance)
{
    STRCMP_CONTAINS("not above the floor_tolerance",
                    refused(kHead + pocket("scallop = 0.02\n")).c_str());
    STRCMP_EQUAL("",
                 refused(kHead + pocket("scallop = 0.02\ntolerance_side = \"both\"\n")).c_str());
}

TEST(JobReader, RefusesAnUnknownStrategyAndAnUnknownTool)
{
    STRCMP_CONTAINS("known are \"contour_pocket\"",
                    refused(kHead + "[[operation]]\nstrategy = \"magic\"\n").c_str());
    STRCMP_CONTAINS("no [[tool]] has that number", refused(kHead + pocket("tool = 9\n")).c_str());
}

TEST(JobReader, RefusesAnOperationWithoutWhatItNeeds)
{
    const std::string operation = kHead + "[[operation]]\nstrategy = \"contour_pocket\"\n";
    STRCMP_CONTAINS("scallop: is missing: length, most that", refused(operation).c_str());
    STRCMP_CONTAINS("floor: is missing: text or list of texts, files of surfaces",
                    refused(operation + "scallop = 0.4\n").c_str());
    STRCMP_CONTAINS("boundary: is missing",
                    refused(kHead +
                            "[[operation]]\nstrategy = \"contour_pocket\"\nscallop = 0.4\n"
                            "floor = \"" +
                            kExampleParts + "suh-lee-floor.json\"\n")
                        .c_str());
    STRCMP_CONTAINS("operation: is missing", refused(kHead).c_str());
}

TEST(JobReader, RefusesAnIslandOutsideTheBoundary)
{
    const std::string square =
        R"({"shape": {"type": "curve", "data": [{"degree": 1, "knotvector": [0, 0, 1, 2, 3, 3],
        "control_points": {"points": [[500, 500], [510, 500], [505, 510], [500, 500]]}}]}})";
    const std::string island = folder.with("island.json", square);
    const std::string text =
        "[[operation]]\nstrategy = \"contour_pocket\"\nscallop = 0.4\nfloor = \"" + kExampleParts +
        "suh-lee-floor.json\"\nboundary = \"" + kExampleParts +
        "suh-lee-boundary.json\"\nislands = [\"island.json\"]\n";
    STRCMP_CONTAINS("the island lies outside the boundary", refused(kHead + text).c_str());
}
