// Beside the rim of a hole: heights of drops and clearances of moves, compared with brute force.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"
#include "tests/support/holed_sheet.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace drop_cutter;
using namespace nurbs;
using namespace part_model;
using namespace toolpath;

namespace {

constexpr double kAccuracy = 2e-3;
constexpr double kHole = 0.25;
constexpr double kToolRadius = 3.0;
constexpr double kAround = 7.5;  // mm: distance of the rim from the middle, about

// Samples of the floor: a grid, and the rim twenty times as dense.
std::vector<Vec3d> places_of(const std::vector<Surface>& floor)
{
    constexpr double kOnRim = 0.01;  // mm
    std::vector<Vec3d> places;
    for (const Surface& surface : floor) {
        const TrimRegion region{surface, 1e-5};
        const int grid = surface.degree_u == 1 ? 50 : 450;
        for (int i = 0; i <= grid; ++i) {
            for (int j = 0; j <= grid; ++j) {
                const double u = static_cast<double>(i) / grid;
                const double v = static_cast<double>(j) / grid;
                if (region.inside(u, v)) {
                    places.push_back(point_at(surface, u, v));
                }
            }
        }
        for (const std::vector<Vec3d>& loop : region.edges(surface)) {
            for (std::size_t side = 0; side + 1 < loop.size(); ++side) {
                const Vec3d a = loop[side];
                const Vec3d b = loop[side + 1];
                const int n = 1 + static_cast<int>(norm(b - a) / kOnRim);
                for (int k = 0; k <= n; ++k) {
                    places.push_back(a + (b - a) * (static_cast<double>(k) / n));
                }
            }
        }
    }
    return places;
}

double highest(const std::vector<Vec3d>& places, const Tool& tool, Vec2d at, double wider)
{
    const double flat = tool.radius - tool.corner_radius;
    const double corner = tool.corner_radius + wider;
    double most = -kUnbounded;
    for (const Vec3d& p : places) {
        const double out = std::max(0.0, std::hypot(p.x - at.x, p.y - at.y) - flat);
        if (out <= corner) {
            most = std::max(most, p.z + std::sqrt(corner * corner - out * out) - corner);
        }
    }
    return most;
}

double distance_to_way(const std::vector<Vec3d>& places, Vec3d a, Vec3d b)
{
    const Vec3d way = b - a;
    double least = 1e300;
    for (const Vec3d& p : places) {
        const double share = std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0);
        const Vec3d off = p - a - way * share;
        least = std::min(least, dot(off, off));
    }
    return std::sqrt(least);
}

Vec2d near_rim(std::mt19937& random)
{
    std::uniform_real_distribution<double> turn{0.0, 6.28318530717958648};
    std::uniform_real_distribution<double> away{kAround - 1.1 * kToolRadius,
                                                kAround + 0.5 * kToolRadius};
    const double angle = turn(random);
    return Vec2d{15.0, 15.0} + Vec2d{std::cos(angle), std::sin(angle)} * away(random);
}

TEST_GROUP(TrimmedFloor)
{
    std::vector<Surface> floor = holed_floor(kHole);
    std::vector<Vec3d> places = places_of(floor);
    std::mt19937 random{71};
};

TEST(TrimmedFloor, HoldsEveryToolAtItsRim)
{
    constexpr double kBetween = 2e-3;  // mm: error by the distance of samples
    for (const Tool& tool : {Tool{1, ToolShape::kBall, kToolRadius, kToolRadius},
                             Tool{1, ToolShape::kBull, kToolRadius, 1.0},
                             Tool{1, ToolShape::kFlat, kToolRadius, 0.0}}) {
        const DropCutter tips{floor, tool, kAccuracy};
        for (int i = 0; i < 60; ++i) {
            const Vec2d at = near_rim(random);
            const double height = tips.tip_height(at);
            CHECK(height >= highest(places, tool, at, 0.0) - 1e-6);
            CHECK(height <= highest(places, tool, at, 0.005) + kAccuracy + kBetween);
        }
    }
}

// Moves that slide over the rim touch it all along: they are examined without being halved.
TEST(TrimmedFloor, TellsTheRoomOfMovesOverItsRim)
{
    const Tool ball{1, ToolShape::kBall, kToolRadius, kToolRadius};
    const DropCutter tips{floor, ball, kAccuracy};
    std::uniform_real_distribution<double> share{-1.0, 1.0};
    for (int i = 0; i < 60; ++i) {
        const Vec2d from = near_rim(random);
        const Vec2d to = from + Vec2d{share(random), share(random)} * (0.2 * kToolRadius);
        const Vec3d a{from.x, from.y, tips.tip_height(from) + 0.05 * share(random)};
        const Vec3d b{to.x, to.y, tips.tip_height(to) + 0.05 * share(random)};
        const Vec3d up{0.0, 0.0, kToolRadius};
        const double room = std::min(0.0, distance_to_way(places, a + up, b + up) - kToolRadius);
        const double gap = tips.move_clearance(a, b);
        CHECK(gap <= room + 1e-9);
        CHECK(gap >= 1.2 * room - 2.0 * kAccuracy);
    }
}

// The sheet is the top of solid material: a ball on the plate cannot reach below the rim.
TEST(TrimmedFloor, LeavesNoPathUnderItsRim)
{
    const Tool ball{1, ToolShape::kBall, kToolRadius, kToolRadius};
    const DropCutter tips{floor, ball, kAccuracy};
    constexpr double kLowLevel = 0.01;  // mm
    int under = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec2d way{std::cos(0.1 * i), std::sin(0.1 * i)};
        const Vec2d from = Vec2d{15.0, 15.0} + way * (kAround - kToolRadius - 1.0);
        const Vec2d to = Vec2d{15.0, 15.0} + way * (kAround - kToolRadius + 0.3);
        double cut = 0.0;
        for (const Vec3d& p : places) {
            const double away = std::hypot(p.x - to.x, p.y - to.y);
            cut = p.z > kLowLevel + kToolRadius ? std::max(cut, kToolRadius - away) : cut;
        }
        under += cut > 0.0 ? 1 : 0;
        CHECK(tips.move_clearance({from.x, from.y, kLowLevel}, {to.x, to.y, kLowLevel}) <=
              1e-3 - cut);
        CHECK(tips.move_clearance({to.x, to.y, kLowLevel}, {to.x, to.y, kLowLevel + 0.5}) <=
              1e-3 - cut);
    }
    CHECK(under > 20);
}

// If the floor ends at the rim, the ball is its radius away from the rim, within the rim's
// accuracy. The halves of a surface of a high degree are large: a count of them does not bound the
// memory.
TEST(TrimmedFloor, ManyDropsKeepSomeTwentyMegabytes)
{
    const Tool ball{1, ToolShape::kBall, kToolRadius, kToolRadius};
    Surface wavy;
    wavy.degree_u = wavy.degree_v = 7;
    wavy.size_u = wavy.size_v = 8;
    wavy.knots_u = wavy.knots_v = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    for (int k = 0; k < 64; ++k) {
        wavy.points.push_back({4.0 * (k / 8), 4.0 * (k % 8), 6.0 * std::sin(2.1 * k)});
        wavy.weights.push_back(1.0 + 0.2 * (k % 2));
    }
    wavy.trims = floor.back().trims;
    const DropCutter cutter{{wavy}, ball, 1e-6};
    std::size_t most = 0;
    for (int k = 0; k < 6000; ++k) {
        const double turn = 0.01 * k;
        cutter.drop(Vec2d{15.0 + kAround * std::cos(turn), 15.0 + kAround * std::sin(turn)});
        most = std::max(most, cutter.kept_bytes());
    }
    CHECK(most > 15'000'000);
    CHECK(most < 22'000'000);
}

TEST(TrimmedFloor, ACutterForAnotherThreadAnswersAsOneAtItsStart)
{
    const Tool ball{1, ToolShape::kBall, kToolRadius, kToolRadius};
    const DropCutter one{floor, ball, kAccuracy};
    const auto place = [](int k) {
        return Vec2d{15.0 + 0.02 * k * std::cos(0.1 * k), 15.0 + 0.02 * k * std::sin(0.1 * k)};
    };
    constexpr int kDrops = 400;
    std::vector<double> heights;
    for (int k = 0; k < kDrops; ++k) {
        heights.push_back(one.tip_height(place(k)));
    }
    const DropCutter other = one.for_thread();
    LONGS_EQUAL(0, other.kept_bytes());
    for (int k = 0; k < kDrops; ++k) {
        CHECK(heights[static_cast<std::size_t>(k)] == other.tip_height(place(k)));
    }
    LONGS_EQUAL(one.halvings(), other.halvings());
}

TEST(TrimmedFloor, EndsAtASmoothRim)
{
    const Tool ball{1, ToolShape::kBall, kToolRadius, kToolRadius};
    const DropCutter tips{floor, ball, kAccuracy};
    constexpr double kCliff = 1.0;  // mm
    for (int i = 0; i < 100; ++i) {
        const Vec2d way{std::cos(0.005 * i), std::sin(0.005 * i)};
        const auto place = [&](double out) {
            return Vec2d{15.0, 15.0} + way * out;
        };
        double low = 0.0;
        double high = kAround;
        while (high - low > 1e-6) {
            const double middle = 0.5 * (low + high);
            (tips.tip_height(place(middle)) > kCliff ? high : low) = middle;
        }
        double nearest = 1e300;
        for (const Vec3d& p : places) {
            if (p.z > kCliff) {
                nearest = std::min(nearest, std::hypot(p.x - place(high).x, p.y - place(high).y));
            }
        }
        DOUBLES_EQUAL(kToolRadius, nearest, 2e-3);
    }
}

}  // namespace
}  // namespace cusp::test
