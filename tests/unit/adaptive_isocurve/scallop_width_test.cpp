// The width between passes against two balls placed beside a circle.
#include "host_tools/adaptive_isocurve/scallop_width.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::host;

TEST_GROUP(ScallopWidth){};

// Radius 6, scallop 0.4; measured by placing balls on circles of these radii.
TEST(ScallopWidth, AgreesWithBallsPlacedOnCircles)
{
    DOUBLES_EQUAL(4.308, scallop_width(6, 0.4, 0), 1e-3);
    DOUBLES_EQUAL(3.737, scallop_width(6, 0.4, -1.0 / 20), 1e-3);
    DOUBLES_EQUAL(4.289, scallop_width(6, 0.4, -1.0 / 733), 1e-3);
    DOUBLES_EQUAL(8.496, scallop_width(6, 0.4, 1.0 / 8), 1e-3);
    DOUBLES_EQUAL(4.610, scallop_width(6, 0.4, 1.0 / 50), 1e-3);
}

TEST(ScallopWidth, LeavesTheRidgeAskedFor)
{
    for (const double rho : {5.0, 20.0, 300.0, -9.0, -40.0}) {
        constexpr double kRadius = 3;
        constexpr double kRidge = 0.02;
        const double chord = scallop_width(kRadius, kRidge, -1 / rho);
        // Both balls touch a circle of radius rho about the origin, half the chord from the axis.
        const double angle = std::asin(0.5 * chord / std::abs(rho));
        const double x = (rho + kRadius) * std::sin(angle);
        const double y = (rho + kRadius) * std::cos(angle);
        const double lower = y - std::sqrt(kRadius * kRadius - x * x);
        DOUBLES_EQUAL(kRidge, lower - rho, 1e-9);
    }
}

TEST(ScallopWidth, StaysFiniteWhereTheBallDoesNotFit)
{
    CHECK(scallop_width(6, 0.4, 10) <= 1.8 * 6);
    CHECK(scallop_width(6, 0.4, 10) > 0);
}
