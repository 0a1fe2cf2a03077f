// Complete isocurves of surfaces that close.
#include "host_tools/cam/adaptive_isocurve/isocurve_extraction.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "tests/support/tube.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::test;

TEST_GROUP(IsocurveExtraction){};

// Its first isocurve is also its last: their distance is 0, with all of the rod between.
TEST(IsocurveExtraction, CompleteOnesGoAllTheWayRoundAClosedSurface)
{
    constexpr double kRadius = 2;
    for (const double distance : {0.5, 1.7, 3.0}) {
        const auto curves = complete_isocurves(tube(kRadius, 10, false), 0, distance);
        const double turn = 2 * std::asin(0.5 * distance / kRadius);
        CHECK(static_cast<double>(curves.size() - 1) >= 2 * kPi / turn);
    }
}
