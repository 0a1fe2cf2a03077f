#include "host_tools/cam/contour_pocket/loop_scallop.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/contour_pocket/height_bounds.hpp"
#include "host_tools/cam/contour_pocket/plan_stepover.hpp"

namespace cusp::test {

using namespace contour_pocket;
using namespace drop_cutter;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kSide = 80.0;  // mm

// A floor over a square around the origin; degree 3 by `n` points a side.
template <class Height>
Surface floor_of(int n, const Height& height)
{
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = s.size_v = n;
    for (int k = 0; k < n + 4; ++k) {
        s.knots_u.push_back(std::min(std::max(k - 3, 0), n - 3));
    }
    s.knots_v = s.knots_u;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            // The points of a straight net are at the averages of knots.
            const auto at = [&](int k) {
                const auto first = s.knots_u.begin() + k + 1;
                return kSide * ((first[0] + first[1] + first[2]) / (3.0 * (n - 3)) - 0.5);
            };
            s.points.push_back({at(i), at(j), height(at(i), at(j))});
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

Region2d square(double half)
{
    const Vec2d a{-half, -half};
    const Vec2d b{half, -half};
    const Vec2d c{half, half};
    const Vec2d d{-half, half};
    return {{{line_edge(a, b), line_edge(b, c), line_edge(c, d), line_edge(d, a)}}};
}

// The scallop between two square loops, as a share of the allowed height, if all moves follow their
// paths exactly.
double share(const Surface& floor, const Tool& tool, double cusp, double step)
{
    ToleranceSplit tolerances;
    tolerances.scallop_height = cusp;
    const RegionOffset walls{square(30.0)};
    const DropCutter tips{{floor}, tool, 1e-4};
    LoopScallop ridge{tips, {floor}, tolerances};
    return ridge.relative_scallop({square(20.0), square(20.0 - step), 10.0, 10.0 + step, walls});
}

const Tool kBall{1, ToolShape::kBall, 6.0, 6.0};
const Tool kFlat{1, ToolShape::kFlat, 6.0, 0.0};

TEST_GROUP(LoopScallop){};

TEST(LoopScallop, KnowsTheCuspOfALevelFloor)
{
    const Surface level = floor_of(4, [](double, double) { return -3.0; });
    // In the loop's corners a cross line ends farther from both.
    const double apart = plan_stepover(6.0, 0.4, 0.0, 0.0);
    CHECK(share(level, kBall, 0.4, apart / std::sqrt(2.0)) < 1.01);
    CHECK(share(level, kBall, 0.4, 1.1 * apart) > 1.2);
}

TEST(LoopScallop, SeesAValleyBetweenTwoPasses)
{
    const Surface valley = floor_of(64, [](double x, double) { return 2.0 * std::abs(x - 18.5); });
    CHECK(share(valley, kBall, 0.1, 3.0) > 1.0);
    CHECK(share(valley, kBall, 0.1, 0.1) < 1.0);
}

TEST(LoopScallop, SeesTheStepsOfAFlatEndMill)
{
    const Surface slope = floor_of(4, [](double x, double) { return 0.5 * x; });
    // Two passes across a slope leave a step as high as the slope over a stepover, along the
    // normal.
    const double step = 0.1 * std::sqrt(1.25) / 0.5;
    const double found = share(slope, kFlat, 0.1, step);
    DOUBLES_EQUAL(1.0, found, 0.1);
}

TEST(LoopScallop, CutsLowestWhereTheToolComesNearest)
{
    const TipSegment level{{-5.0, 0.0, 1.0}, {5.0, 0.0, 1.0}};
    DOUBLES_EQUAL(1.0 + 6.0 - std::sqrt(35.0), cut_over(kBall, level, {0.0, 1.0}), 1e-9);
    DOUBLES_EQUAL(1.0, cut_over(kFlat, level, {0.0, 5.9}), 1e-12);
    CHECK(cut_over(kFlat, level, {0.0, 6.1}) > 1e6);
    const Tool bull{1, ToolShape::kBull, 6.0, 2.0};
    const TipSegment slope{{-5.0, 0.0, 0.0}, {5.0, 0.0, 5.0}};
    double least = 1e300;
    for (int i = 0; i <= 10000; ++i) {
        const double x = -5.0 + 1e-3 * i;
        const double away = std::hypot(x - 1.0, 2.0);
        least = std::min(least, 0.5 * (x + 5.0) + profile_height(bull, away));
    }
    DOUBLES_EQUAL(least, cut_over(bull, slope, {1.0, 2.0}), 1e-5);
}

TEST_GROUP(HeightBounds){};

TEST(HeightBounds, HoldAtEveryPlaceLookedAt)
{
    const auto height = [](double x, double y) {
        return 4.0 * std::sin(0.11 * x + 0.3) * std::cos(0.09 * y);
    };
    const Surface floor = floor_of(14, height);
    const HeightBounds bounds{{floor}, 3.0};
    for (double u = 2.0; u < 9.0; u += 0.37) {
        for (double v = 2.0; v < 9.0; v += 0.41) {
            const SurfacePoint s = derivatives_at(floor, u, v);
            const part_model::BendBounds here =
                bounds.near({s.point.x, s.point.y, s.point.x, s.point.y});
            const Vec3d n = upward_normal(s);
            const double slope = std::hypot(n.x, n.y) / n.z;
            // The net is straight in plan: x depends on u only.
            const double xx = (s.duu.z - s.du.z / s.du.x * s.duu.x) / (s.du.x * s.du.x);
            CHECK(slope <= here.slope * (1.0 + 1e-9));
            CHECK(xx <= here.up * (1.0 + 1e-9) && -xx <= here.down * (1.0 + 1e-9));
            CHECK(here.slope < 2.0 && here.up < 1.0);
        }
    }
}

TEST(HeightBounds, ProveTheIntervalOfALevelFloor)
{
    const double half = 0.5 * plan_stepover(6.0, 0.4, 0.0, 0.0);
    DOUBLES_EQUAL(half, proven_reach(6.0, 0.4, {0.0, 0.0, 0.0}), 1e-6);
}

// The formula is for circles, which curve more beside their lowest point than a parabola.
TEST(HeightBounds, ProveNearlyTheIntervalOfABentFloor)
{
    for (const double rho : {-12.0, -50.0, 20.0, 50.0}) {
        const double bend = 1.0 / std::abs(rho);
        const part_model::BendBounds bounds{0.0, rho < 0.0 ? bend : 0.0, rho < 0.0 ? 0.0 : bend};
        const double half = 0.5 * plan_stepover(6.0, 0.1, 1.0 / rho, 0.0);
        const double proven = proven_reach(6.0, 0.1, bounds);
        CHECK(proven <= half * 1.01 && proven > 0.8 * half);
    }
}

TEST(HeightBounds, ProveNothingWhereTheBallDoesNotFit)
{
    DOUBLES_EQUAL(0.0, proven_reach(6.0, 0.1, {0.0, 0.2, 0.0}), 0.0);
}

// Both passes climb everywhere: the rim sweeps an ellipse, and ridges between are low.
TEST(LoopScallop, LowRidgesOfAFlatEndAreKnownToBeLow)
{
    const Tool flat{1, ToolShape::kFlat, 2.0, 0.0};
    const Surface slope = floor_of(4, [](double x, double y) { return x + 0.5 * y; });
    const double low = share(slope, flat, 0.05, 0.2);
    CHECK(low > 0.0);
    CHECK(low < 0.6);
}

// Down a valley that is too narrow for it a flat end leaves steps as high as the valley falls
// between passes.
TEST(LoopScallop, StepsThatAFlatEndLeavesDownAFurrowCount)
{
    const Tool flat{1, ToolShape::kFlat, 2.0, 0.0};
    constexpr int kPoints = 60;
    const Surface furrow =
        floor_of(kPoints, [](double x, double y) { return std::abs(x) + 0.5 * y; });
    CHECK(share(furrow, flat, 0.05, 0.2) >= 0.95 * 0.5 * 0.2 / 0.05);
}

}  // namespace
}  // namespace cusp::test
