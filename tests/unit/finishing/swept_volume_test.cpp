// The lowest free place over a point, compared with every move as many balls along it.
#include "host_tools/cam/finishing/swept_volume.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;

namespace {

constexpr double kSweptRadius = 2;
constexpr int kBalls = 4000;  // along a move

double lowest_by_balls(const std::vector<Vec3d>& tips, double x, double y)
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < tips.size(); ++k) {
        for (int i = 0; i <= kBalls; ++i) {
            const double share = static_cast<double>(i) / kBalls;
            const Vec3d tip = tips[k - 1] * (1 - share) + tips[k] * share;
            const double square =
                kSweptRadius * kSweptRadius - (tip.x - x) * (tip.x - x) - (tip.y - y) * (tip.y - y);
            if (square >= 0) {
                least = std::min(least, tip.z + kSweptRadius - std::sqrt(square));
            }
        }
    }
    return least;
}

}  // namespace

TEST_GROUP(SweptVolume){};

// Looking each move up in the list of those before took seconds.
TEST(SweptVolume, NamesManyNearMovesOnceAndSoon)
{
    constexpr unsigned kSeed = 7;
    constexpr std::uint32_t kMoves = 40000;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> place{-0.4, 0.4};
    std::vector<Vec3d> tips;
    for (std::uint32_t k = 0; k <= kMoves; ++k) {
        tips.push_back({place(random), place(random), 0});
    }
    SweptVolume swept{kSweptRadius, 0.5};
    swept.add(tips);
    std::vector<std::uint32_t> near;
    const std::clock_t begin = std::clock();
    for (int k = 0; k < 10; ++k) {
        swept.near({0, 0, kSweptRadius}, near);
    }
    CHECK(std::clock() - begin < CLOCKS_PER_SEC);
    LONGS_EQUAL(kMoves, near.size());
    for (std::uint32_t k = 0; k < kMoves; ++k) {
        CHECK(near[k] == k);
    }
}

TEST(SweptVolume, LeaveWhatTheLowestOfAllBallsLeaves)
{
    constexpr unsigned kSeed = 20261122;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> plan{-12, 12};
    std::uniform_real_distribution<double> height{-6, 6};
    for (const double reach : {0.05, 0.4, 3.0}) {
        std::vector<Vec3d> tips;
        for (int k = 0; k < 12; ++k) {
            tips.push_back({plan(random), plan(random), height(random)});
        }
        SweptVolume swept{kSweptRadius, reach};
        swept.add(tips);
        for (int k = 0; k < 60; ++k) {
            const double x = plan(random);
            const double y = plan(random);
            const double by_balls = lowest_by_balls(tips, x, y);
            const double found = swept.lowest(x, y).height;
            if (std::isfinite(by_balls)) {
                CHECK(found <= by_balls + 1e-9);
                // At the edge of a ball a step of 0.01 mm between balls has a large effect.
                CHECK(found > by_balls - 0.3);
            }
        }
    }
}

TEST(SweptVolume, LeaveNothingFreeBesideThem)
{
    SweptVolume swept{kSweptRadius, 0.5};
    CHECK(std::isinf(swept.lowest(0, 0).height));
    swept.add({{0, 0, 1}, {10, 0, 1}});
    CHECK(std::isinf(swept.lowest(5, 2.01).height));
    DOUBLES_EQUAL(1, swept.lowest(5, 0).height, 1e-12);
    DOUBLES_EQUAL(3, swept.lowest(5, 2).height, 1e-6);
}

// Over a wall, stock straight above a point is beside the shank, not the ball.
TEST(SweptVolume, RemoveWhatTheShankPasses)
{
    constexpr unsigned kSeed = 70;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> at{-4, 4};
    int removed = 0;
    for (int k = 0; k < 300; ++k) {
        const std::vector<Vec3d> tips{{at(random), at(random), at(random)},
                                      {at(random), at(random), at(random)}};
        SweptVolume swept{kSweptRadius, 0.5};
        swept.add(tips);
        const Vec3d p{at(random), at(random), at(random) + 2};
        const double lowest = swept.lowest(p.x, p.y).height;
        if (std::abs(p.z - lowest) > 1e-6) {
            CHECK_EQUAL(p.z > lowest, swept.removes(0, p, 0));
            removed += p.z > lowest ? 1 : 0;
        }
    }
    CHECK(removed > 50);
}
