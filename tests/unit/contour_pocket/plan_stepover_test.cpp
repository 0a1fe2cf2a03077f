#include "host_tools/cam/contour_pocket/plan_stepover.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/contour_pocket/loop_spacing.hpp"

namespace cusp::test {

using namespace contour_pocket;
using namespace toolpath;

namespace {

// The scallop between two balls whose centres lie `apart` on a circle about the centre of curvature.
double scallop_of_balls(double radius, double rho, double apart)
{
    const double half = 0.5 * apart;
    const double to_centre = radius + rho;
    const double along = std::sqrt(to_centre * to_centre - half * half);
    // The lower crossing of both balls on the axis, as seen from the centre of curvature.
    const double sagitta = std::sqrt(radius * radius - half * half);
    return rho > 0.0 ? along - sagitta - rho : -(along + sagitta) - rho;
}

TEST_GROUP(PlanStepover){};

TEST(PlanStepover, LeavesExactlyTheScallopAskedForBetweenTwoBalls)
{
    for (const double rho : {20.0, 50.0, 733.0, -8.0, -12.0, -50.0, -733.0}) {
        const double apart = plan_stepover(6.0, 0.4, 1.0 / rho, 0.0);
        DOUBLES_EQUAL(0.4, scallop_of_balls(6.0, rho, apart), 1e-9);
    }
}

TEST(PlanStepover, IsTheChordOfTheBallOnAFlatFloor)
{
    DOUBLES_EQUAL(2.0 * std::sqrt(0.4 * 11.6), plan_stepover(6.0, 0.4, 0.0, 0.0), 1e-12);
    DOUBLES_EQUAL(4.3081, plan_stepover(6.0, 0.4, 1e-12, 0.0), 1e-4);
}

TEST(PlanStepover, ShrinksInPlanOnASlope)
{
    DOUBLES_EQUAL(plan_stepover(6.0, 0.4, 0.0, 0.0) / std::sqrt(2.0),
                  plan_stepover(6.0, 0.4, 0.0, 1.0), 1e-12);
}

TEST(PlanStepover, StaysFiniteWhereTheBallDoesNotFit)
{
    for (const double rho : {-6.0, -5.9, -1.0, -0.4, -1e-6, 1e-6}) {
        const double apart = plan_stepover(6.0, 0.4, 1.0 / rho, 0.0);
        CHECK(apart > 0.0 && apart < 12.0);
    }
}

TEST_GROUP(LoopSpacing){};

TEST(LoopSpacing, FindsTheRidgeOfAFlatFloor)
{
    const Tool ball{1, ToolShape::kBall, 6.0, 6.0};
    const std::vector<double> level(9, -3.0);
    const double apart = plan_stepover(6.0, 0.4, 0.0, 0.0);
    DOUBLES_EQUAL(0.4, scallop_between(ball, level, apart), 1e-3);
}

TEST(LoopSpacing, FindsTheRidgeInAValleyBetweenTwoPasses)
{
    const Tool ball{1, ToolShape::kBall, 6.0, 6.0};
    std::vector<double> valley;
    for (int i = 0; i <= 8; ++i) {
        valley.push_back(0.5 * std::abs(0.25 * i - 1.0));
    }
    // Half a millimetre lower in the middle than at both passes, 2 mm apart.
    CHECK(scallop_between(ball, valley, 2.0) > 0.4);
    CHECK(scallop_between(ball, {valley.begin(), valley.begin() + 5}, 1.0) < 0.05);
}

}  // namespace
}  // namespace cusp::test
