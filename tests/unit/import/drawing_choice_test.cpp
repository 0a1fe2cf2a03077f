// Shapes of a drawing by their nesting: which loops, circles and chains each value of `loops` takes.
#include "host_tools/job/import/drawing_choice.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/drawn_shapes.hpp"

using namespace cusp;
using namespace cusp::import;

namespace {

constexpr double kTurn = 6.283185307179586;

FileLoop circle(double radius, int depth)
{
    return {{arc_curve({0, 0}, radius, 0, kTurn)}, "", depth - 1, depth};
}

// Circles of 40, 20, 10 and 4 mm in each other, and two lines that were joined over a gap.
FileShapes target()
{
    FileShapes shapes{{circle(20, 0), circle(10, 1), circle(5, 2), circle(2, 3)}, {}};
    job::OpenChain open{};
    open.pieces = {line_curve({0, 0}, {1, 0}), line_curve({1, 0}, {2, 0}),
                   line_curve({2.01, 0}, {3, 0})};
    shapes.open.push_back(open);
    return shapes;
}

std::size_t loops(const char* which) { return chosen_loops({{}, which, {}}, target()).size(); }

}  // namespace

TEST_GROUP(DrawingChoice){};

TEST(DrawingChoice, TakesLoopsByDepth)
{
    CHECK_EQUAL(4U, loops("all"));
    CHECK_EQUAL(1U, loops("outer"));
    CHECK_EQUAL(3U, loops("inner"));
    CHECK_EQUAL(0U, loops("open"));
}

TEST(DrawingChoice, IslandsAreNoHolesToDrill)
{
    const std::vector<job::Hole> holes = chosen_circles({{}, "inner", {}}, target());
    CHECK_EQUAL(2U, holes.size());
    DOUBLES_EQUAL(20, holes[0].diameter, 1e-9);
    DOUBLES_EQUAL(4, holes[1].diameter, 1e-9);
}

TEST(DrawingChoice, LeavesCirclesOfOtherOperations)
{
    const auto rest = chosen_loops({{}, "inner", {4.005, 9.9}}, target());
    CHECK_EQUAL(2U, rest.size());
    CHECK_EQUAL(0, rest.front().depth);
    CHECK_EQUAL(1, rest.back().depth);
}

TEST(DrawingChoice, ChainsEndAtGapsThatWereJoined)
{
    const std::vector<job::Chain> open = chosen_chains({{}, "open", {}}, target());
    CHECK_EQUAL(2U, open.size());
    CHECK_EQUAL(2U, open[0].size());
    CHECK_EQUAL(6U, chosen_chains({{}, "all", {}}, target()).size());
    CHECK_EQUAL(3U, chosen_chains({{}, "inner", {}}, target()).size());
}
