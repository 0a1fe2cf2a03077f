// A tube and a holed sheet in plan.
#include "host_tools/geometry/part_model/surface_height_map.hpp"

#include <cmath>
#include <random>

#include "tests/support/holed_sheet.hpp"
#include "tests/support/tube.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace nurbs;
using namespace part_model;

namespace {

constexpr double kMapEdgeError = 1e-4;  // mm
constexpr double kBarRadius = 10;

}  // namespace

TEST_GROUP(SurfaceHeightMap){};

TEST(SurfaceHeightMap, IsTheUpperOfTwoSheets)
{
    const SurfaceHeightMap heights{{tube(kBarRadius, 30, true)}, kMapEdgeError};
    std::mt19937 random{1};
    std::uniform_real_distribution<double> x{-kBarRadius, kBarRadius};
    std::uniform_real_distribution<double> y{0, 30};
    for (int k = 0; k < 3000; ++k) {
        const double at = x(random);
        const auto height = heights.at(at, y(random));
        CHECK(height.has_value());
        DOUBLES_EQUAL(std::sqrt(kBarRadius * kBarRadius - at * at), *height, 1e-4);
    }
}

TEST(SurfaceHeightMap, IsFoundBesideTheSilhouette)
{
    const SurfaceHeightMap heights{{tube(kBarRadius, 30, true)}, kMapEdgeError};
    for (double beside = 1e-2; beside > 1e-5; beside *= 0.5) {
        const double at = kBarRadius - beside;
        const auto height = heights.at(at, 12.3);
        CHECK(height.has_value());
        // the root is accurate in x to 1e-7 mm
        DOUBLES_EQUAL(std::sqrt(kBarRadius * kBarRadius - at * at), *height,
                      2e-7 * kBarRadius / beside);
    }
    CHECK(!heights.at(kBarRadius + 1e-5, 12.3));
    CHECK(!heights.at(0, -1e-5));
}

TEST(SurfaceHeightMap, IsNoneOverAHole)
{
    Surface sheet = holed_sheet(0.2);
    const SurfaceHeightMap holed{{sheet}, kMapEdgeError};
    CHECK(!holed.at(15, 15));
    CHECK(holed.at(3, 3).has_value());
    sheet.trims.clear();
    const SurfaceHeightMap whole{{sheet}, kMapEdgeError};
    CHECK(whole.at(15, 15).has_value());
    DOUBLES_EQUAL(*whole.at(3, 3), *holed.at(3, 3), 1e-9);
}

}  // namespace cusp::test
