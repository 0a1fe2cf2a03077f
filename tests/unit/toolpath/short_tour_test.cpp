#include "host_tools/geometry/toolpath/short_tour.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/toolpath/near_places.hpp"

using cusp::Vec2d;
using cusp::toolpath::inner_first_tour;
using cusp::toolpath::NearPlaces;
using cusp::toolpath::short_tour;
using cusp::toolpath::TourStep;
using cusp::toolpath::TourStop;

namespace {

std::vector<Vec2d> scattered(unsigned seed, std::size_t count)
{
    std::mt19937 random{seed};
    std::vector<Vec2d> places(count);
    for (Vec2d& p : places) {
        p.x = static_cast<double>(random() % 10000) / 100;
        p.y = static_cast<double>(random() % 10000) / 100;
    }
    return places;
}

}  // namespace

TEST_GROUP(ShortTour){};

TEST(ShortTour, NearPlacesAreThoseOfBruteForceUntilTheyAreTaken)
{
    for (unsigned seed = 1; seed < 20; ++seed) {
        const std::vector<Vec2d> places = scattered(seed, 5 + 17 * seed);
        NearPlaces near{places};
        std::vector<std::pair<double, std::size_t>> left;
        const Vec2d p = scattered(seed + 100, 1).front();
        for (std::size_t k = 0; k < places.size(); ++k) {
            if (k % 3 == 0) {
                near.take(k);
            } else {
                left.emplace_back(norm(places[k] - p), k);
            }
        }
        std::sort(left.begin(), left.end());
        const auto found = near.nearest(p, 6);
        CHECK_EQUAL(std::min<std::size_t>(6, left.size()), found.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            CHECK_EQUAL(left[k].second, found[k]);
        }
    }
}

TEST(ShortTour, OpenPathsAreEnteredAtTheirNearerEnds)
{
    const std::vector<TourStop> rows{{{0, 0}, {50, 0}}, {{0, 1}, {50, 1}}, {{0, 2}, {50, 2}}};
    const std::vector<TourStep> steps = short_tour(rows, {0, -1});
    CHECK_EQUAL(std::size_t{3}, steps.size());
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK_EQUAL(k, steps[k].stop);
        CHECK_EQUAL(k == 1, steps[k].turned);
    }
}

TEST(ShortTour, TheWayToAnEndCounts)
{
    const std::vector<Vec2d> row{{10, 0}, {20, 0}, {30, 0}, {40, 0}};
    CHECK_EQUAL(std::size_t{0}, short_tour(row, {26, 0}, Vec2d{60, 0}).front());
    CHECK_EQUAL(std::size_t{0}, short_tour(row, {26, 0}, Vec2d{-10, 0}).back());
}

TEST(ShortTour, EachPlaceComesAfterAllThatLieInIt)
{
    for (unsigned seed = 1; seed < 60; ++seed) {
        std::mt19937 random{seed};
        const std::vector<Vec2d> places = scattered(seed, 1 + 3 * seed);
        std::vector<std::optional<std::size_t>> outer(places.size());
        for (std::size_t k = 1; k < places.size(); ++k) {
            if (random() % 3 != 0) {
                outer[k] = random() % k;
            }
        }
        const std::vector<std::size_t> order = inner_first_tour(places, outer, {0, 0});
        std::vector<std::size_t> when(places.size(), places.size());
        for (std::size_t k = 0; k < order.size(); ++k) {
            when[order[k]] = k;
        }
        CHECK_EQUAL(places.size(), order.size());
        for (std::size_t k = 0; k < places.size(); ++k) {
            CHECK(when[k] < places.size());
            CHECK(!outer[k] || when[k] < when[*outer[k]]);
        }
    }
}
