// Sections at the poles of a ball, where derivatives are rounding.
#include "host_tools/cam/adaptive_isocurve/cross_section.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::nurbs;

TEST_GROUP(CrossSectionTest){};

// At the pole of a ball S_u is rounding: a curvature from it would require endless numbers of
// passes.
TEST(CrossSectionTest, OfABallIsTheSameAtItsPole)
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
    DOUBLES_EQUAL(1 / kRadius, section.curvature, 1e-12);
    DOUBLES_EQUAL(kRadius, section.speed, 1e-12);
}

// The same for S_v where the poles are the ends of the curves.
TEST(CrossSectionTest, KnowsNoCurvatureWhereAllCurvesMeet)
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
