// Shares hold each number once, alike in size, and hardly overlap.
#include "host_tools/cam/finishing/shares_of_neighbours.hpp"

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;

TEST_GROUP(SharesOfNeighbours){};

TEST(SharesOfNeighbours, HoldEachPlaceOnceAndLieApart)
{
    constexpr unsigned kSeed = 31;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_int_distribution<int> at{0, 40};  // many places are equal
    for (std::size_t count = 0; count < 300; ++count) {
        std::vector<Vec2d> places(count);
        for (Vec2d& place : places) {
            place = {1.0 * at(random), 3.0 * at(random)};
        }
        const auto shares = shares_of_neighbours(places, 8);
        LONGS_EQUAL(std::min<std::size_t>(count, 8), shares.size());
        std::vector<int> held(count, 0);
        double area = 0;
        for (const auto& share : shares) {
            CHECK(std::is_sorted(share.begin(), share.end()));
            CHECK(share.size() >= count / 8 && share.size() <= count / 8 + 1);
            Vec2d low{1e9, 1e9};
            Vec2d high{-1e9, -1e9};
            for (const std::size_t k : share) {
                ++held[k];
                low = {std::min(low.x, places[k].x), std::min(low.y, places[k].y)};
                high = {std::max(high.x, places[k].x), std::max(high.y, places[k].y)};
            }
            area += (high.x - low.x) * (high.y - low.y);
        }
        CHECK(std::all_of(held.begin(), held.end(), [](int times) { return times == 1; }));
        CHECK(area <= 40.0 * 120.0 + 1e-9);
    }
}
