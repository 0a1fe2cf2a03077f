#include "host_tools/cam/clearing/partial_loops.hpp"

#include <algorithm>

#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;
using namespace job;
using namespace offset;

namespace {

Contour centred_square(double half)
{
    const Vec2d a{-half, -half};
    const Vec2d b{half, -half};
    const Vec2d c{half, half};
    const Vec2d d{-half, half};
    return {line_edge(a, b), line_edge(b, c), line_edge(c, d), line_edge(d, a)};
}

// One loop at half a step and its partial loop over 4 mm of the lower side.
ClearedRegion one_loop(CutDirection direction)
{
    const RegionOffset walls{{{centred_square(20.0)}}};
    ClearedRegion cleared;
    cleared.direction = direction;
    ClearingPass pass;
    pass.path =
        direction == CutDirection::kClimb ? centred_square(17.0) : reversed(centred_square(17.0));
    cleared.passes = {pass};
    cleared.partial = loops_over({line_edge({-2.0, -17.0}, {2.0, -17.0})}, walls, 3.0, 4.0, 0.5);
    return cleared;
}

void check_runs_on(const Contour& path)
{
    for (std::size_t e = 0; e < path.size(); ++e) {
        CHECK(distance(path[e].end, path[(e + 1) % path.size()].start) < 1e-9);
    }
}

TEST_GROUP(PartialLoops){};

TEST(PartialLoops, LieStraightInwardFromTheirFeet)
{
    const std::vector<PartialLoop> loops = one_loop(CutDirection::kClimb).partial;
    LONGS_EQUAL(1, loops.size());
    CHECK_FALSE(loops[0].whole);
    const Contour& path = loops[0].path;
    DOUBLES_EQUAL(-16.0, path.front().start.y, 1e-6);
    DOUBLES_EQUAL(-16.0, path.back().end.y, 1e-6);
    // Up to the end of the margin, and less than half of it beyond.
    CHECK(path.front().start.x <= -2.45 && path.front().start.x > -3.0);
    CHECK(path.back().end.x >= 2.45 && path.back().end.x < 3.0);
}

TEST(PartialLoops, OverMostOfALoopAreTheLoop)
{
    const RegionOffset walls{{{centred_square(20.0)}}};
    const Contour level = centred_square(17.0);
    const std::vector<PartialLoop> loops =
        loops_over({level[0], level[1], level[2]}, walls, 3.0, 4.0, 0.5);
    LONGS_EQUAL(1, loops.size());
    CHECK(loops[0].whole);
    DOUBLES_EQUAL(8.0 * 16.0, length(loops[0].path), 1e-6);
    DOUBLES_EQUAL(8.0 * 16.0 + 2.0, added_length(loops), 1e-6);
}

TEST(PartialLoops, LeaveTheirLoopSquareToItAndComeBack)
{
    for (const CutDirection direction : {CutDirection::kClimb, CutDirection::kConventional}) {
        ClearedRegion cleared = one_loop(direction);
        const double sign = direction == CutDirection::kClimb ? 1.0 : -1.0;
        const double added = added_length(cleared.partial);
        put_in_partial_loops(cleared);
        const Contour& path = cleared.passes[0].path;
        check_runs_on(path);
        DOUBLES_EQUAL(8.0 * 17.0 + added, length(path), 1e-6);
        // At first it runs in the direction of its loop.
        const auto first = std::find_if(path.begin(), path.end(), [](const Edge& edge) {
            return edge.start.y > -16.001 && edge.end.y > -16.001 && edge.start.y < -15.999 &&
                   edge.end.y < -15.999;
        });
        CHECK(first != path.end());
        CHECK(sign * (first->end.x - first->start.x) > 4.0);
        const Edge& there = *(first - 1);
        DOUBLES_EQUAL(there.start.x, there.end.x, 1e-9);
        DOUBLES_EQUAL(-17.0, there.start.y, 1e-9);
    }
}

}  // namespace
}  // namespace cusp::test
