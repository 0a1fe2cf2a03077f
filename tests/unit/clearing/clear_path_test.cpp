#include "host_tools/cam/clearing/clear_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"

namespace cusp::test {

using namespace clearing;
using namespace offset;

namespace {

Contour square(double half, double angle)
{
    Contour loop;
    std::array<Vec2d, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) {
        const double a = angle + (static_cast<double>(i) + 0.5) * 0.5 * kPi;
        corners[i] = Vec2d{std::cos(a), std::sin(a)} * (half * std::sqrt(2.0));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        loop.push_back(line_edge(corners[i], corners[(i + 1) % 4]));
    }
    return loop;
}

// Least distance of the path from the contours, by brute force; below zero where it leaves the region.
double nearest_on_way(const Region2d& region, const Edge& way)
{
    constexpr int kPlaces = 6000;
    double least = 1e300;
    for (int i = 0; i <= kPlaces; ++i) {
        const Vec2d p = point_on(way, static_cast<double>(i) / kPlaces);
        least = std::min(least, contains(region, p) ? distance_to(region, p) : -1.0);
    }
    return least;
}

TEST_GROUP(ClearPath){};

TEST(ClearPath, IsKnownToAHundredThousandthOfAMillimetre)
{
    constexpr unsigned kSeed = 20261122;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> any{-1.0, 1.0};
    int inside = 0;
    for (int n = 0; n < 300; ++n) {
        Region2d region{{square(20.0, 0.0), reversed(square(5.0, any(random)))}};
        const RegionOffset walls{region};
        const Vec2d from{18.0 * any(random), 18.0 * any(random)};
        const Vec2d to{from.x + 3.0 * any(random), from.y + 3.0 * any(random)};
        const Vec2d middle = (from + to) * 0.5;
        const Vec2d centre = middle + left_normal(to - from) * any(random);
        const bool leftward = dot(centre - middle, left_normal(to - from)) > 0.0;
        const Edge way =
            n % 2 == 0 ? line_edge(from, to) : arc_edge(from, to, centre, leftward ? 1 : -1);
        const double room = nearest_on_way(region, way);
        if (room < 0.1) {
            CHECK_FALSE(room < 0.0 && is_path_clear(walls, way, 0.0));
            continue;
        }
        ++inside;
        CHECK(is_path_clear(walls, way, room - 1e-6));
        CHECK_FALSE(is_path_clear(walls, way, room + 1.1e-5));
    }
    CHECK(inside > 100);
}

TEST(ClearPath, AlongAWallAtExactlyTheLeastDistance)
{
    const RegionOffset walls{{{square(20.0, 0.0)}}};
    CHECK(is_path_clear(walls, line_edge({-17.0, -17.0}, {17.0, -17.0}), 3.0));
    CHECK_FALSE(is_path_clear(walls, line_edge({-17.0, -17.0}, {17.0, -17.001}), 3.0));
    CHECK(is_path_clear(walls, line_edge({-20.0, 0.0}, {20.0, 0.0}), 0.0));
    CHECK_FALSE(is_path_clear(walls, line_edge({-20.1, 0.0}, {20.0, 0.0}), 0.0));
}

}  // namespace
}  // namespace cusp::test
