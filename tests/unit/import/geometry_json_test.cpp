// Geometry files: the papers' parts, and everything that can be wrong with a file.
#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "tests/support/example_parts.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::test;

namespace {

std::string line(const std::string& from, const std::string& to)
{
    return R"({"degree": 1, "knotvector": [0, 0, 1, 1], "control_points": {"points": [)" + from +
           ", " + to + "]}}";
}

std::string curves(const std::string& data, int count)
{
    return R"({"shape": {"type": "curve", "count": )" + std::to_string(count) + R"(, "data": [)" +
           data + "]}}";
}

std::string bilinear(const std::string& change_from = "", const std::string& change_to = "")
{
    std::string text = R"({"shape": {"type": "surface", "count": 1, "data": [
        {"degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
         "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
         "control_points": {"points": [[0, 0, 0], [0, 10, 0], [20, 0, 0], [20, 10, 0]],
                            "weights": [1, 1, 1, 1]}}]}})";
    if (!change_from.empty()) {
        text.replace(text.find(change_from), change_from.size(), change_to);
    }
    return text;
}

}  // namespace

TEST_GROUP(GeometryJson)
{
    cusp::test::TemporaryFolder folder;

    std::string surface_refusal(const std::string& text)
    {
        const std::string file = folder.with("s.json", text);
        return cusp::test::refusal([&] { read_surfaces(file); });
    }
    std::string loop_refusal(const std::string& text)
    {
        const std::string file = folder.with("c.json", text);
        return cusp::test::refusal([&] { read_loop(file); });
    }
};

TEST(GeometryJson, ReadsTheBoundaryOfThePocketCounterClockwise)
{
    const Loop loop = read_loop(kExampleParts + "suh-lee-boundary.json");
    LONGS_EQUAL(12, loop.size());
    CHECK(signed_area(loop_polyline(loop, 0.01)) > 0);
}

TEST(GeometryJson, ReadsEveryReplicaPart)
{
    LONGS_EQUAL(1, read_surfaces(kExampleParts + "suh-lee-floor.json").size());
    LONGS_EQUAL(7, read_surfaces(kExampleParts + "elber-cohen-house-on-the-hill.json").size());
    LONGS_EQUAL(1, read_surfaces(kExampleParts + "chuang-pan-tap.json").size());
    LONGS_EQUAL(8, read_loop(kExampleParts + "suh-lee-island.json").size());
    LONGS_EQUAL(9, read_loop(kExampleParts + "choi-polygon-boundary.json").size());
}

TEST(GeometryJson, ScalesInchesToMillimetres)
{
    const auto inch = read_surfaces(kExampleParts + "choi-polygon-floor.json", 25.4);
    const auto unitless = read_surfaces(kExampleParts + "choi-polygon-floor.json");
    DOUBLES_EQUAL(25.4 * unitless[0].points[5].x, inch[0].points[5].x, 1e-12);
    DOUBLES_EQUAL(25.4 * unitless[0].points[5].z, inch[0].points[5].z, 1e-12);
}

TEST(GeometryJson, TurnsAClockwiseLoop)
{
    const std::string file =
        folder.with("c.json", curves(line("[0, 0]", "[0, 5]") + "," + line("[0, 5]", "[5, 5]") +
                                         "," + line("[5, 5]", "[0, 0]"),
                                     3));
    CHECK(signed_area(loop_polyline(read_loop(file), 0.01)) > 0);
}

TEST(GeometryJson, TurnsSingleCurvesThatRunAgainstTheLoop)
{
    const std::string file =
        folder.with("c.json", curves(line("[5, 0]", "[0, 0]") + "," + line("[5, 5]", "[5, 0]") +
                                         "," + line("[5, 5]", "[0, 0]"),
                                     3));
    DOUBLES_EQUAL(12.5, signed_area(loop_polyline(read_loop(file), 0.01)), 1e-9);
}

TEST(GeometryJson, ClosesGapsBelowAMicrometre)
{
    const std::string file = folder.with(
        "c.json", curves(line("[0, 0]", "[5, 0]") + "," + line("[5, 0.0009]", "[5, 5]") + "," +
                             line("[5, 5]", "[0, 0]"),
                         3));
    const Loop loop = read_loop(file);
    DOUBLES_EQUAL(loop[0].points.back().y, loop[1].points.front().y, 0);
}

TEST(GeometryJson, RefusesAnOpenLoopWithItsGap)
{
    STRCMP_CONTAINS(
        "open",
        loop_refusal(curves(line("[0, 0]", "[5, 0]") + "," + line("[5, 0]", "[5, 5]"), 2)).c_str());
}

TEST(GeometryJson, RefusesALoopThatCrossesItself)
{
    const std::string bow_tie = line("[0, 0]", "[5, 5]") + "," + line("[5, 5]", "[5, 0]") + "," +
                                line("[5, 0]", "[0, 4]") + "," + line("[0, 4]", "[0, 0]");
    STRCMP_CONTAINS("crosses itself", loop_refusal(curves(bow_tie, 4)).c_str());
}

TEST(GeometryJson, RefusesALoopWithoutArea)
{
    STRCMP_CONTAINS(
        "no area",
        loop_refusal(curves(line("[0, 0]", "[5, 5]") + "," + line("[5, 5]", "[0, 0]"), 2)).c_str());
}

TEST(GeometryJson, RefusesACurveWithoutLength)
{
    STRCMP_CONTAINS("no length", loop_refusal(curves(line("[1, 1]", "[1, 1]"), 1)).c_str());
}

TEST(GeometryJson, RefusesAMissingFileByName)
{
    const std::string text =
        cusp::test::refusal([&] { read_surfaces(folder.file("nowhere.json")); });
    STRCMP_CONTAINS("nowhere.json", text.c_str());
    STRCMP_CONTAINS("No such file", text.c_str());
}

TEST(GeometryJson, RefusesBrokenJsonWithItsLine)
{
    STRCMP_CONTAINS("line 2", surface_refusal("{\"shape\":\n {\"type\": ").c_str());
}

TEST(GeometryJson, RefusesCurvesWhereSurfacesBelong)
{
    STRCMP_CONTAINS("\"surface\" is needed",
                    surface_refusal(curves(line("[0, 0]", "[5, 5]"), 1)).c_str());
}

TEST(GeometryJson, RefusesAWrongCount)
{
    STRCMP_CONTAINS("count is 2",
                    surface_refusal(bilinear("\"count\": 1", "\"count\": 2")).c_str());
}

TEST(GeometryJson, RefusesKnotsThatDecrease)
{
    STRCMP_CONTAINS("knotvector_u[3] is 0.5, below the 1 before it",
                    surface_refusal(bilinear("[0, 0, 1, 1]", "[0, 0, 1, 0.5]")).c_str());
}

TEST(GeometryJson, RefusesTooFewKnots)
{
    STRCMP_CONTAINS("holds 3 numbers",
                    surface_refusal(bilinear("[0, 0, 1, 1]", "[0, 0, 1]")).c_str());
}

TEST(GeometryJson, RefusesKnotsWithoutADomain)
{
    STRCMP_CONTAINS("no domain", surface_refusal(bilinear("[0, 0, 1, 1]", "[0, 0, 0, 0]")).c_str());
}

TEST(GeometryJson, RefusesADegreeOfZero)
{
    STRCMP_CONTAINS("degree_u is 0",
                    surface_refusal(bilinear("\"degree_u\": 1", "\"degree_u\": 0")).c_str());
}

TEST(GeometryJson, RefusesAHugeSize)
{
    STRCMP_CONTAINS("size_u",
                    surface_refusal(bilinear("\"size_u\": 2", "\"size_u\": 2e9")).c_str());
    STRCMP_CONTAINS("4 control points",
                    surface_refusal(bilinear("\"size_u\": 2", "\"size_u\": 1000000")).c_str());
}

TEST(GeometryJson, RefusesWeightsThatAreNotPositive)
{
    STRCMP_CONTAINS("weight 1 is -1",
                    surface_refusal(bilinear("[1, 1, 1, 1]", "[1, -1, 1, 1]")).c_str());
    STRCMP_CONTAINS("3 weights", surface_refusal(bilinear("[1, 1, 1, 1]", "[1, 1, 1]")).c_str());
}

TEST(GeometryJson, RefusesCoordinatesBeyondEveryMachine)
{
    STRCMP_CONTAINS("control point 2 has x",
                    surface_refusal(bilinear("[20, 0, 0]", "[1e300, 0, 0]")).c_str());
}

TEST(GeometryJson, RefusesNumbersTooLargeForDoubles)
{
    STRCMP_CONTAINS("not JSON", surface_refusal(bilinear("[20, 0, 0]", "[1e999, 0, 0]")).c_str());
}

TEST(GeometryJson, RefusesWordsForNumbers)
{
    STRCMP_CONTAINS("is not a number",
                    surface_refusal(bilinear("[20, 0, 0]", "[\"far\", 0, 0]")).c_str());
}

TEST(GeometryJson, RefusesASurfaceThatIsALine)
{
    STRCMP_CONTAINS("no area", surface_refusal(bilinear("[0, 10, 0], [20, 0, 0], [20, 10, 0]",
                                                        "[10, 0, 0], [20, 0, 0], [30, 0, 0]"))
                                   .c_str());
}
