// The stepover against two balls placed beside a circle.
#include "host_tools/geometry/toolpath/stepover.hpp"

#include <cmath>
#include <limits>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::toolpath;

TEST_GROUP(Stepover){};

// Radius 6, scallop 0.4; measured by placing balls on circles of these radii.
TEST(Stepover, AgreesWithBallsPlacedOnCircles)
{
    DOUBLES_EQUAL(4.308, stepover(6, 0.4, 0), 1e-3);
    DOUBLES_EQUAL(3.737, stepover(6, 0.4, 1.0 / 20), 1e-3);
    DOUBLES_EQUAL(4.289, stepover(6, 0.4, 1.0 / 733), 1e-3);
    DOUBLES_EQUAL(8.496, stepover(6, 0.4, -1.0 / 8), 1e-3);
    DOUBLES_EQUAL(4.610, stepover(6, 0.4, -1.0 / 50), 1e-3);
}

TEST(Stepover, LeavesTheScallopAskedFor)
{
    for (const double rho : {5.0, 20.0, 300.0, -9.0, -40.0}) {
        constexpr double kRadius = 3;
        constexpr double kScallop = 0.02;
        const double chord = stepover(kRadius, kScallop, 1 / rho);
        // Both balls touch a circle of radius rho about the origin, half the chord from the axis.
        const double angle = std::asin(0.5 * chord / std::abs(rho));
        const double x = (rho + kRadius) * std::sin(angle);
        const double y = (rho + kRadius) * std::cos(angle);
        const double lower = y - std::sqrt(kRadius * kRadius - x * x);
        DOUBLES_EQUAL(kScallop, lower - rho, 1e-9);
    }
}

TEST(Stepover, IsTheChordOfTheBallOnAPlane)
{
    DOUBLES_EQUAL(2.0 * std::sqrt(0.4 * 11.6), stepover(6.0, 0.4, 0.0), 1e-12);
    DOUBLES_EQUAL(4.3081, stepover(6.0, 0.4, 1e-12), 1e-4);
}

TEST(Stepover, IsNoMoreThanTheWidest)
{
    DOUBLES_EQUAL(1.8 * 6, stepover(6, 0.4, -10), 0);
    DOUBLES_EQUAL(0.5 * 6, stepover(6, 0.4, 0, 0.5), 0);
    CHECK(std::isinf(stepover(6, 0.4, -10, std::numeric_limits<double>::infinity())));
}
