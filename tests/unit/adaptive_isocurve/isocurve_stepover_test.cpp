// The width between passes against two balls placed beside a circle.
#include "host_tools/adaptive_isocurve/isocurve_stepover.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::nurbs;

TEST_GROUP(IsocurveStepover){};

// Radius 6, scallop 0.4; measured by placing balls on circles of these radii.
TEST(IsocurveStepover, AgreesWithBallsPlacedOnCircles)
{
    DOUBLES_EQUAL(4.308, isocurve_stepover(6, 0.4, 0), 1e-3);
    DOUBLES_EQUAL(3.737, isocurve_stepover(6, 0.4, -1.0 / 20), 1e-3);
    DOUBLES_EQUAL(4.289, isocurve_stepover(6, 0.4, -1.0 / 733), 1e-3);
    DOUBLES_EQUAL(8.496, isocurve_stepover(6, 0.4, 1.0 / 8), 1e-3);
    DOUBLES_EQUAL(4.610, isocurve_stepover(6, 0.4, 1.0 / 50), 1e-3);
}

TEST(IsocurveStepover, LeavesTheRidgeAskedFor)
{
    for (const double rho : {5.0, 20.0, 300.0, -9.0, -40.0}) {
        constexpr double kRadius = 3;
        constexpr double kRidge = 0.02;
        const double chord = isocurve_stepover(kRadius, kRidge, -1 / rho);
        // Both balls touch a circle of radius rho about the origin, half the chord from the axis.
        const double angle = std::asin(0.5 * chord / std::abs(rho));
        const double x = (rho + kRadius) * std::sin(angle);
        const double y = (rho + kRadius) * std::cos(angle);
        const double lower = y - std::sqrt(kRadius * kRadius - x * x);
        DOUBLES_EQUAL(kRidge, lower - rho, 1e-9);
    }
}

TEST(IsocurveStepover, StaysFiniteWhereTheBallDoesNotFit)
{
    CHECK(isocurve_stepover(6, 0.4, 10) <= 1.8 * 6);
    CHECK(isocurve_stepover(6, 0.4, 10) > 0);
}

// S_u is rounding at the pole of a ball: a curvature from that asked for endless numbers of passes.
TEST(IsocurveStepover, OfABallIsTheSameAtItsPole)
{
    constexpr double kRadius = 12;
    SurfacePoint pole;
    pole.point = {0, 0, kRadius};
    pole.du = {3e-16, -7e-16, 1e-16};
    pole.dv = {kRadius, 0, 0};
    pole.duu = {-7e-16, -3e-16, 0};
    pole.duv = {0, kRadius, 0};
    pole.dvv = {0, 0, -kRadius};
    const CrossSection section = cross_section_at(pole);
    DOUBLES_EQUAL(-1 / kRadius, section.curvature, 1e-12);
    DOUBLES_EQUAL(kRadius, section.speed, 1e-12);
}

// And S_v where the poles are the ends of the curves.
TEST(IsocurveStepover, KnowsNoCurvatureWhereAllCurvesMeet)
{
    constexpr double kRadius = 12;
    SurfacePoint pole;
    pole.point = {0, 0, kRadius};
    pole.du = {kRadius, 0, 0};
    pole.dv = {3e-16, -7e-16, 1e-16};
    pole.duu = {0, 0, -kRadius};
    pole.duv = {0, kRadius, 0};
    pole.dvv = {-7e-16, -3e-16, 1e-16};
    DOUBLES_EQUAL(0, cross_section_at(pole).curvature, 0);
}
