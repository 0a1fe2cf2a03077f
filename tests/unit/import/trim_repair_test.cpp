// Loops of CAD faces that are open, or cross themselves at a cusp.
#include "host_tools/job/import/trim_repair.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/trim_cusps.hpp"
#include "host_tools/job/import/trim_lobes.hpp"
#include "host_tools/job/import/trim_loops.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "tests/support/refusal.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::nurbs;

namespace {

// 10 mm wide, u and v in millimetres.
Surface square()
{
    return {1,
            1,
            {0, 0, 10, 10},
            {0, 0, 10, 10},
            2,
            2,
            {{0, 0, 0}, {0, 10, 0}, {10, 0, 0}, {10, 10, 0}},
            {1, 1, 1, 1},
            {}};
}

Curve line(Vec2d a, Vec2d b) { return {1, {0, 0, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}}, {1, 1}}; }

Curve parabola(Vec2d a, Vec2d b, Vec2d c)
{
    return {2, {0, 0, 0, 1, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}, {c.x, c.y, 0}}, {1, 1, 1}};
}

double area_of(const std::vector<Curve>& loop)
{
    return job::signed_area(job::loop_polyline(loop, 1e-6));
}

}  // namespace

TEST_GROUP(TrimRepair){};

TEST(TrimRepair, ClosesAGapThatTheFileAllows)
{
    const Vec2d a{1, 1};
    const Vec2d b{9, 1};
    const Vec2d c{5, 8};
    const Vec2d beside{5.03, 8.04};  // 0.05 from c
    for (const double allowed : {0.06, 0.04}) {
        std::vector<Curve> loop{line(a, b), line(b, c), line(beside, a)};
        const LoopRepair gaps = bridge_gaps(loop, {false, false, false}, allowed, square());
        LONGS_EQUAL(allowed > 0.05 ? 4 : 3, loop.size());
        DOUBLES_EQUAL(allowed > 0.05 ? 0.05 : 0, gaps.widest_gap, 1e-12);
        DOUBLES_EQUAL(0, gaps.longest_point, 0);
    }
}

TEST(TrimRepair, TakesALineForAnEdgeThatIsAPoint)
{
    std::vector<Curve> loop{line({1, 1}, {9, 1}), line({9, 1}, {9, 8}), line({1, 8}, {1, 1})};
    const LoopRepair gaps = bridge_gaps(loop, {false, true, false}, 0.01, square());
    LONGS_EQUAL(4, loop.size());
    DOUBLES_EQUAL(8, gaps.longest_point, 1e-12);
    DOUBLES_EQUAL(56, area_of(loop), 1e-9);
}

// Two edges leave a vertex almost along each other, and cross 0.05 mm beside it.
TEST(TrimRepair, CutsACuspWhoseEdgesCrossByRounding)
{
    const Vec2d tip{8, 2};
    // near the tip the lower edge lies up to 0.0003 mm above the upper one
    std::vector<Curve> loop{parabola({1, 1}, {6, 2.05}, tip), parabola(tip, {6, 2}, {4, 9}),
                            line({4, 9}, {1, 1})};
    const double before = std::abs(area_of(loop));
    STRCMP_CONTAINS("cross", test::refusal([&] { trim_loops(loop, square(), "face 1"); }).c_str());
    DOUBLES_EQUAL(0, cut_cusps(loop, 1e-4, square()), 0);
    const double widest = cut_cusps(loop, 0.01, square());
    CHECK(widest > 2e-4 && widest < 2e-3);
    LONGS_EQUAL(4, loop.size());
    LONGS_EQUAL(1, trim_loops(loop, square(), "face 1").size());
    DOUBLES_EQUAL(before, area_of(loop), 1e-3);
}

TEST(TrimRepair, LeavesCornersAsTheyAre)
{
    std::vector<Curve> loop{line({1, 1}, {9, 1}), line({9, 1}, {9, 8}), line({9, 8}, {1, 1})};
    DOUBLES_EQUAL(0, cut_cusps(loop, 0.1, square()), 0);
    LONGS_EQUAL(3, loop.size());
}

// The edge from (9, 1) overshoots (9, 8) by 0.5 mm and comes back 0.02 mm beside itself.
TEST(TrimRepair, CutsALobeWhereAnEdgeOvershootsItsVertex)
{
    const std::vector<Curve> loop{line({1, 1}, {9, 1}), line({9, 1}, {9, 8.5}),
                                  line({9, 8.5}, {9.02, 8}), line({9.02, 8}, {1, 8}),
                                  line({1, 8}, {1, 1})};
    STRCMP_CONTAINS("cross", test::refusal([&] { trim_loops(loop, square(), "face 1"); }).c_str());
    CHECK_FALSE(cut_lobes(loop, 0.005, square()).has_value());
    const auto cut = cut_lobes(loop, 0.1, square());
    CHECK(cut.has_value());
    LONGS_EQUAL(1, cut->loops.size());
    LONGS_EQUAL(1, trim_loops(cut->loops[0], square(), "face 1").size());
    DOUBLES_EQUAL(56, area_of(cut->loops[0]), 1e-9);
    DOUBLES_EQUAL(4 * (0.5 * 0.5 * 0.02) / (0.5 + 0.02 + std::hypot(0.5, 0.02)), cut->widest, 1e-6);
}

// Two edges change sides twice: between the crossings they enclose a lobe 0.02 mm wide.
TEST(TrimRepair, KeepsWhatLiesBeyondALobe)
{
    const std::vector<Curve> loop{line({1, 1}, {4, 1}),    line({4, 1}, {5, 2.01}),
                                  line({5, 2.01}, {6, 1}), line({6, 1}, {9, 1}),
                                  line({9, 1}, {9, 3}),    line({9, 3}, {6, 3}),
                                  line({6, 3}, {5, 1.99}), line({5, 1.99}, {4, 3}),
                                  line({4, 3}, {1, 3}),    line({1, 3}, {1, 1})};
    const auto cut = cut_lobes(loop, 0.1, square());
    CHECK(cut.has_value());
    LONGS_EQUAL(2, cut->loops.size());
    std::vector<Curve> all;
    for (const std::vector<Curve>& one : cut->loops) {
        CHECK(area_of(one) > 6.9);
        all.insert(all.end(), one.begin(), one.end());
    }
    LONGS_EQUAL(2, trim_loops(all, square(), "face 1").size());
    CHECK(cut->widest > 0.005 && cut->widest < 0.03);
}
