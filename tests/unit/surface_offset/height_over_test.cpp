// A tube and a holed sheet, seen from above.
#include "host_tools/surface_offset/height_over.hpp"

#include <cmath>
#include <random>

#include "tests/support/holed_sheet.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::host {
namespace {

constexpr double kEdgeError = 1e-4;  // mm
constexpr double kRadius = 10;

// A whole circle of radius 10 about the y axis, 30 long: seen from above twice, upright at x = 10.
Surface tube()
{
    Surface s;
    s.degree_u = 2;
    s.degree_v = 1;
    s.knots_u = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    s.knots_v = {0, 0, 1, 1};
    s.size_u = 9;
    s.size_v = 2;
    constexpr double kWay[][2] = {{1, 1},  {0, 1},  {-1, 1}, {-1, 0}, {-1, -1},
                                  {0, -1}, {1, -1}, {1, 0},  {1, 1}};
    for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 2; ++j) {
            s.points.push_back({kRadius * kWay[i][0], 30.0 * j, kRadius * kWay[i][1]});
            s.weights.push_back(i % 2 == 1 ? 1 : std::sqrt(0.5));
        }
    }
    // corners of the square are off the circle: begin on it
    for (std::size_t k = 0; k < 18; ++k) {
        const std::size_t next = (k / 2 + 1) % 8;
        s.points[k] = {kRadius * kWay[next][0], s.points[k].y, kRadius * kWay[next][1]};
        s.weights[k] = next % 2 == 1 ? 1 : std::sqrt(0.5);
    }
    return s;
}

}  // namespace

TEST_GROUP(HeightOver){};

TEST(HeightOver, IsTheUpperOfTwoSheets)
{
    const HeightOver heights{{tube()}, kEdgeError};
    std::mt19937 random{1};
    std::uniform_real_distribution<double> x{-kRadius, kRadius};
    std::uniform_real_distribution<double> y{0, 30};
    for (int k = 0; k < 3000; ++k) {
        const double at = x(random);
        const auto height = heights.at(at, y(random));
        CHECK(height.has_value());
        DOUBLES_EQUAL(std::sqrt(kRadius * kRadius - at * at), *height, 1e-4);
    }
}

TEST(HeightOver, IsFoundBesideTheSilhouette)
{
    const HeightOver heights{{tube()}, kEdgeError};
    for (double beside = 1e-2; beside > 1e-5; beside *= 0.5) {
        const double at = kRadius - beside;
        const auto height = heights.at(at, 12.3);
        CHECK(height.has_value());
        // the root is told in x to 1e-7 mm
        DOUBLES_EQUAL(std::sqrt(kRadius * kRadius - at * at), *height, 2e-7 * kRadius / beside);
    }
    CHECK(!heights.at(kRadius + 1e-5, 12.3));
    CHECK(!heights.at(0, -1e-5));
}

TEST(HeightOver, IsNoneOverAHole)
{
    Surface sheet = holed_sheet(0.2);
    const HeightOver holed{{sheet}, kEdgeError};
    CHECK(!holed.at(15, 15));
    CHECK(holed.at(3, 3).has_value());
    sheet.trims.clear();
    const HeightOver whole{{sheet}, kEdgeError};
    CHECK(whole.at(15, 15).has_value());
    DOUBLES_EQUAL(*whole.at(3, 3), *holed.at(3, 3), 1e-9);
}

}  // namespace cusp::host
