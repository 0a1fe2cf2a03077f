// Trims: outer loops and holes, and trims that contradict each other.
#include "host_tools/job/import/trim_loops.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/job/job/loop_shape.hpp"
#include "tests/support/refusal.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::nurbs;

namespace {

Surface unit_square()
{
    return {1,
            1,
            {0, 0, 1, 1},
            {0, 0, 1, 1},
            2,
            2,
            {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}},
            {1, 1, 1, 1},
            {}};
}

// A closed polygon of degree 1, counter-clockwise.
Curve square_loop(double low, double high)
{
    return {1,
            {0, 0, 1, 2, 3, 4, 4},
            {{low, low, 0}, {high, low, 0}, {high, high, 0}, {low, high, 0}, {low, low, 0}},
            {1, 1, 1, 1, 1}};
}

}  // namespace

TEST_GROUP(TrimLoops){};

TEST(TrimLoops, PutsTheOuterLoopFirst)
{
    const auto loops =
        trim_loops({reversed(square_loop(0.4, 0.6)), square_loop(0.1, 0.9)}, unit_square(), "s");
    LONGS_EQUAL(2, loops.size());
    DOUBLES_EQUAL(0.64, signed_area(loop_polyline(loops[0], 1e-3)), 1e-12);
    DOUBLES_EQUAL(-0.04, signed_area(loop_polyline(loops[1], 1e-3)), 1e-12);
}

TEST(TrimLoops, TakesTheDomainAsOuterLoopOfALoneHole)
{
    const auto loops = trim_loops({reversed(square_loop(0.4, 0.6))}, unit_square(), "s");
    LONGS_EQUAL(2, loops.size());
    DOUBLES_EQUAL(1.0, signed_area(loop_polyline(loops[0], 1e-3)), 1e-12);
}

TEST(TrimLoops, ChainsOpenCurves)
{
    const auto halves = split_at(square_loop(0.1, 0.9), 1.5);
    const auto loops = trim_loops({halves[0], halves[1]}, unit_square(), "s");
    LONGS_EQUAL(1, loops.size());
    LONGS_EQUAL(2, loops[0].size());
}

TEST(TrimLoops, RefusesAHoleThatRunsLikeAnOuterLoop)
{
    STRCMP_CONTAINS(
        "contradict",
        cusp::test::refusal([] {
            trim_loops({square_loop(0.1, 0.9), square_loop(0.4, 0.6)}, unit_square(), "s");
        }).c_str());
}

TEST(TrimLoops, RefusesATrimOutsideTheDomain)
{
    STRCMP_CONTAINS("leaves the domain", cusp::test::refusal([] {
                                             trim_loops({square_loop(0.5, 1.5)}, unit_square(),
                                                        "s");
                                         }).c_str());
}

TEST(TrimLoops, RefusesAnOpenTrim)
{
    STRCMP_CONTAINS("open", cusp::test::refusal([] {
                                trim_loops({split_at(square_loop(0.1, 0.9), 1.5)[0]}, unit_square(),
                                           "s");
                            }).c_str());
}

TEST(TrimLoops, RefusesAHoleOutsideTheOuterLoop)
{
    STRCMP_CONTAINS("outside every outer loop",
                    cusp::test::refusal([] {
                        trim_loops({square_loop(0.1, 0.4), reversed(square_loop(0.6, 0.9))},
                                   unit_square(), "s");
                    }).c_str());
}

TEST(TrimLoops, RefusesLoopsThatCross)
{
    STRCMP_CONTAINS("cross", cusp::test::refusal([] {
                                 trim_loops(
                                     {square_loop(0.1, 0.6), reversed(square_loop(0.4, 0.9))},
                                     unit_square(), "s");
                             }).c_str());
}

TEST(TrimLoops, RefusesALoopThatCrossesItself)
{
    Curve eight = square_loop(0.1, 0.9);
    std::swap(eight.points[1], eight.points[2]);
    STRCMP_CONTAINS("cross",
                    cusp::test::refusal([&] { trim_loops({eight}, unit_square(), "s"); }).c_str());
}
