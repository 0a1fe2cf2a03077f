// Jobs out of one line: what is chosen, by which part and tools, and what is refused.
#include "host_tools/job/import/one_line_job.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/support/example_parts.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

#include "fmt/format.h"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::test;

namespace {

// A plane from (0, 0) to (60, 40), from z = a at x = 0 to z = b.
std::string ramp(double a, double b)
{
    return fmt::format(R"({{"shape": {{"type": "surface", "count": 1, "data": [{{
        "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
        "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
        "control_points": {{"points": [[0, 0, {0}], [0, 40, {0}], [60, 0, {1}], [60, 40, {1}]]}}
        }}]}}}})",
                       a, b);
}

}  // namespace

TEST_GROUP(OneLineJob)
{
    cusp::test::TemporaryFolder folder;

    OneLineRequest request(double a, double b)
    {
        OneLineRequest out;
        out.parts = {folder.with("ramp.json", ramp(a, b))};
        out.tools = {"ball:6"};
        out.scallop = 0.02;
        return out;
    }
    Job job_of(const OneLineRequest& asked)
    {
        PartFiles parts;
        const OneLineJob job = one_line_job(asked, cusp::strategies::all(), parts);
        return read_job({job.toml, "the call", ""}, cusp::strategies::all(), parts);
    }
    bool says(const OneLineRequest& asked, const std::string& words)
    {
        PartFiles parts;
        const std::vector<std::string> said =
            one_line_job(asked, cusp::strategies::all(), parts).said;
        return std::any_of(said.begin(), said.end(), [&](const std::string& line) {
            return line.find(words) != std::string::npos;
        });
    }
    // The job of a request with one change.
    std::string refused(const std::function<void(OneLineRequest&)>& change)
    {
        OneLineRequest asked = request(-10, 5);
        change(asked);
        return cusp::test::refusal([&] { job_of(asked); });
    }
};

TEST(OneLineJob, TakesTheStockFromThePart)
{
    const Job job = job_of(request(12.5, 30));
    DOUBLES_EQUAL(30, job.stock_top, 1e-9);
    DOUBLES_EQUAL(12.5, job.stock_bottom.value(), 1e-9);
    DOUBLES_EQUAL(5, job.clearance, 1e-9);
    CHECK(says(request(12.5, 30), "part: 60 x 40 mm from above, 17.5 deep"));
    CHECK(says(
        request(12.5, 30),
        "stock: x 0 to 60, y 0 to 40, top z = 30 (the part's; --stock-top); cut down to z = 12.5"));
}

TEST(OneLineJob, RoughsADeepPartWithItsOnlyTool)
{
    const Job job = job_of(request(-10, 5));
    const Operation& operation = job.operations.front();
    STRCMP_EQUAL("adaptive_isocurve", operation.name().c_str());
    CHECK(operation.passes.roughing);
    CHECK_EQUAL(1U, operation.tools.size());
    CHECK_EQUAL(1, operation.tool.number);
    DOUBLES_EQUAL(3, operation.levels.max_depth.value(), 0);
    DOUBLES_EQUAL(0.3, operation.passes.allowance, 0);
    DOUBLES_EQUAL(0.02, operation.tolerance.scallop.value(), 0);
    DOUBLES_EQUAL(0.01, operation.tolerance.floor, 0);
    CHECK(says(request(-10, 5), "roughing: ball 6 mm, layers of at most 3 mm (half the diameter"));
}

TEST(OneLineJob, LeavesOutRoughingOfWhatOneCutTakes)
{
    CHECK_FALSE(job_of(request(0, 2.9)).operations.front().passes.roughing);
    CHECK(job_of(request(0, 3.1)).operations.front().passes.roughing);
    CHECK_FALSE(job_of(request(7, 7)).operations.front().passes.roughing);
    CHECK(says(request(7, 7), "roughing: none"));
    OneLineRequest asked = request(0, 20);
    asked.roughing = false;
    CHECK_FALSE(job_of(asked).operations.front().passes.roughing);
}

TEST(OneLineJob, RoughsWithAllToolsButTheLast)
{
    OneLineRequest asked = request(0, 2);
    asked.tools = {"flat:10", "bull:8:1", "ball:3"};
    const Job job = job_of(asked);
    const Operation& operation = job.operations.front();
    CHECK(operation.passes.roughing);
    CHECK_EQUAL(2U, operation.tools.size());
    CHECK_EQUAL(3, operation.tool.number);
    DOUBLES_EQUAL(1.0, job.tools[1].corner_radius, 0);
    DOUBLES_EQUAL(4, operation.levels.max_depth.value(), 0);  // of the smaller one
    // a plate within the allowance: nothing to rough, and no error
    asked.parts = {folder.with("plate.json", ramp(0, 0.2))};
    CHECK_FALSE(job_of(asked).operations.front().passes.roughing);
}

TEST(OneLineJob, ChoosesTheToleranceByTheScallopAndTheFeedByTheTool)
{
    OneLineRequest asked = request(0, 2);
    asked.scallop = 0.004;
    asked.tools = {"ball:1"};
    Job job = job_of(asked);
    DOUBLES_EQUAL(0.002, job.operations.front().tolerance.floor, 0);
    DOUBLES_EQUAL(200, job.feed, 1e-9);
    DOUBLES_EQUAL(50, job.plunge_feed, 1e-9);
    CHECK(says(asked, "feed 200 mm/min, plunge feed 50, spindle 12000 rpm: defaults"));
    asked.scallop = 0.5;
    asked.tools = {"ball:20"};
    job = job_of(asked);
    DOUBLES_EQUAL(0.01, job.operations.front().tolerance.floor, 0);
    DOUBLES_EQUAL(1200, job.feed, 1e-9);
}

TEST(OneLineJob, TakesWhatIsAskedFor)
{
    OneLineRequest asked = request(0, 20);
    asked.feed = 900;
    asked.plunge_feed = 111;
    asked.spindle = 5000;
    asked.max_depth = 2.5;
    asked.allowance = 0.1;
    asked.tolerance = 0.005;
    asked.stock_top = 22;
    asked.clearance = 9;
    asked.output = "arcs";
    const Job job = job_of(asked);
    const Operation& operation = job.operations.front();
    DOUBLES_EQUAL(900, job.feed, 0);
    DOUBLES_EQUAL(111, job.plunge_feed, 0);
    DOUBLES_EQUAL(5000, job.spindle, 0);
    DOUBLES_EQUAL(2.5, operation.levels.max_depth.value(), 0);
    DOUBLES_EQUAL(0.1, operation.passes.allowance, 0);
    DOUBLES_EQUAL(0.005, operation.tolerance.floor, 0);
    DOUBLES_EQUAL(22, job.stock_top, 0);
    DOUBLES_EQUAL(9, job.clearance, 0);
    CHECK(operation.output == OutputForm::kArcs);
    CHECK(says(asked, "feed 900 mm/min, plunge feed 111, spindle 5000 rpm"));
    CHECK_FALSE(says(asked, "defaults"));
}

TEST(OneLineJob, InInchesHasRoundNumbersOfInches)
{
    OneLineRequest asked = request(0, 2);
    asked.inch = true;
    asked.tools = {"ball:6.35mm"};
    asked.scallop = 0.001;
    const Job job = job_of(asked);
    CHECK(job.inch);
    DOUBLES_EQUAL(2 * 25.4, job.stock_top, 1e-9);
    DOUBLES_EQUAL(3.175, job.operations.front().tool.radius, 1e-9);
    DOUBLES_EQUAL(47 * 25.4, job.feed, 1e-9);
    DOUBLES_EQUAL(0.0004 * 25.4, job.operations.front().tolerance.floor, 1e-12);
    CHECK(says(asked, "part: 60 x 40 inch from above, 2 deep"));
}

TEST(OneLineJob, WithABoundaryIsAPocket)
{
    OneLineRequest asked;
    asked.parts = {kExampleParts + "suh-lee-floor.json"};
    asked.boundary = kExampleParts + "suh-lee-boundary.json";
    asked.islands = {kExampleParts + "suh-lee-island.json"};
    asked.tools = {"flat:10", "ball:12"};
    asked.scallop = 0.4;
    const Job job = job_of(asked);
    const Operation& operation = job.operations.front();
    STRCMP_EQUAL("contour_pocket", operation.name().c_str());
    DOUBLES_EQUAL(0, job.stock_top, 0);
    CHECK_EQUAL(1U, operation.outline.islands.size());
    CHECK_EQUAL(1, operation.tools.front().number);
    CHECK_EQUAL(2, operation.tool.number);
    DOUBLES_EQUAL(5, operation.levels.max_depth.value(), 0);
}

TEST(OneLineJob, WritesAnyNameOfAFile)
{
    OneLineRequest asked = request(0, 2);
    asked.parts = {folder.with("a \"b\\c'\t d\xC3\xA9.json", ramp(0, 2))};
    CHECK_EQUAL(1U, job_of(asked).operations.front().part.floor.size());
}

TEST(OneLineJob, ReadsAPartOnce)
{
    const OneLineRequest asked = request(0, 2);
    PartFiles parts;
    const OneLineJob job = one_line_job(asked, cusp::strategies::all(), parts);
    folder.with("ramp.json", "gone");
    CHECK_EQUAL(1U, read_job({job.toml, "the call", ""}, cusp::strategies::all(), parts)
                        .operations.front()
                        .part.floor.size());
}

TEST(OneLineJob, RefusesPartsThatAreNone)
{
    const auto part = [&](const std::string& name) {
        return refused([&](OneLineRequest& asked) { asked.parts = {name}; });
    };
    STRCMP_CONTAINS("none.json: can't be read", part("none.json").c_str());
    STRCMP_CONTAINS("part.ply: parts end in .json", part("part.ply").c_str());
    STRCMP_CONTAINS("--scallop: is for surfaces", part("plate.dxf#a").c_str());
    STRCMP_CONTAINS("--island: needs --boundary",
                    refused([](OneLineRequest& asked) { asked.islands = {"i.json"}; }).c_str());
}

TEST(OneLineJob, RefusesToolsThatCannotFinish)
{
    const auto tools = [&](const std::vector<std::string>& names) {
        return refused([&](OneLineRequest& asked) { asked.tools = names; });
    };
    STRCMP_CONTAINS("--tool: is missing", tools({}).c_str());
    STRCMP_CONTAINS("--tool taper:6:5:0.5: a taper only finishes",
                    tools({"taper:6:5:0.5", "ball:6"}).c_str());
    STRCMP_CONTAINS("--tool ball:61: its diameter is 61 mm, the part is only 60 x 40",
                    tools({"ball:61"}).c_str());
    STRCMP_CONTAINS("give one tool, which finishes", refused([](OneLineRequest& asked) {
                                                         asked.tools = {"flat:8", "ball:6"};
                                                         asked.roughing = false;
                                                     }).c_str());
}

TEST(OneLineJob, RefusesNumbersOutOfRange)
{
    const auto number = [&](std::optional<double> OneLineRequest::*which, double value) {
        return refused([&](OneLineRequest& asked) { asked.*which = value; });
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    STRCMP_CONTAINS("--scallop: is nan", number(&OneLineRequest::scallop, nan).c_str());
    STRCMP_CONTAINS("--scallop: is 0, it must be above 1e-05",
                    number(&OneLineRequest::scallop, 0).c_str());
    STRCMP_CONTAINS("--feed: is -1, it must be at least 0.01",
                    number(&OneLineRequest::feed, -1).c_str());
    STRCMP_CONTAINS("--tolerance: is 0.02, it must be below the --scallop of 0.02",
                    number(&OneLineRequest::tolerance, 0.02).c_str());
    STRCMP_CONTAINS("--max-depth: is 0", number(&OneLineRequest::max_depth, 0).c_str());
    STRCMP_CONTAINS("--stock-top: is 4 mm, but ", number(&OneLineRequest::stock_top, 4).c_str());
    STRCMP_CONTAINS("rises to z = 5", number(&OneLineRequest::stock_top, 4).c_str());
    STRCMP_CONTAINS("--scallop: is missing",
                    refused([](OneLineRequest& asked) { asked.scallop.reset(); }).c_str());
    STRCMP_CONTAINS("--no-roughing leaves that out", refused([](OneLineRequest& asked) {
                                                         asked.roughing = false;
                                                         asked.max_depth = 2;
                                                     }).c_str());
}

TEST(OneLineJob, RefusesStrategiesThatDoNotFit)
{
    const auto strategy = [&](const char* name) {
        return refused([&](OneLineRequest& asked) { asked.strategy = name; });
    };
    STRCMP_CONTAINS("needs --boundary", strategy("contour_pocket").c_str());
    STRCMP_CONTAINS("only finishes: add --no-roughing", strategy("parallel_planes").c_str());
}
