// Complete isocurves of surfaces that close.
#include "host_tools/adaptive_isocurve/isocurve_extraction.hpp"

#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"

using namespace cusp;
using namespace cusp::host;

namespace {

// A round rod along x: u along it, v once round it.
Surface rod(double radius)
{
    Surface s;
    s.degree_u = 1;
    s.degree_v = 2;
    s.knots_u = {0, 0, 1, 1};
    s.knots_v = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    s.size_u = 2;
    s.size_v = 9;
    const double half = std::sqrt(0.5);
    const std::vector<Vec2d> ring{{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                  {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (const double x : {0.0, 10.0}) {
        for (std::size_t k = 0; k < ring.size(); ++k) {
            s.points.push_back({x, radius * ring[k].x, radius * ring[k].y});
            s.weights.push_back(k % 2 == 0 ? 1 : half);
        }
    }
    return s;
}

}  // namespace

TEST_GROUP(IsocurveExtraction){};

// Its first isocurve is its last, too: they are no distance apart, with all of the rod between.
TEST(IsocurveExtraction, CompleteOnesGoAllTheWayRoundAClosedSurface)
{
    constexpr double kRadius = 2;
    for (const double distance : {0.5, 1.7, 3.0}) {
        const auto curves = complete_isocurves(rod(kRadius), 0, distance);
        const double turn = 2 * std::asin(0.5 * distance / kRadius);
        CHECK(static_cast<double>(curves.size() - 1) >= 2 * kPi / turn);
    }
}
