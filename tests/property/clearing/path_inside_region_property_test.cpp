// Paths between random points of random regions with islands stay inside, and are found wherever
// there is one.
#include <cstdio>

#include "host_tools/cam/clearing/path_inside_region.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;
using namespace offset;

namespace {

Vec2d random_place(Random& random, const Region2d& region)
{
    const Box2d box = box_of(region);
    while (true) {
        const Vec2d p{uniform(random, box.x0, box.x1), uniform(random, box.y0, box.y1)};
        if (contains(region, p)) {
            return p;
        }
    }
}

// The outer contour round the place: no part of such a region lies inside another.
std::size_t part_of(const Region2d& region, Vec2d p)
{
    std::size_t i = 0;
    while (area(region.contours[i]) < 0.0 || !surrounds(region.contours[i], p)) {
        ++i;
    }
    return i;
}

void check_way(const Region2d& region, const std::vector<Edge>& way, Vec2d from, Vec2d to)
{
    Vec2d at = from;
    for (const Edge& edge : way) {
        CHECK(distance(at, edge.start) <= 1e-6);
        for (double share = 0.0; share <= 1.0; share += 1.0 / 16) {
            const Vec2d p = point_on(edge, share);
            CHECK(contains(region, p) || distance_to(region, p) <= 1e-5);
        }
        at = edge.end;
    }
    CHECK(distance(at, to) <= 1e-6);
}

TEST_GROUP(PathInsideRegion){};

TEST(PathInsideRegion, StaysInsideAndIsFoundInEveryPart)
{
    constexpr unsigned kSeed = 1986;
    constexpr int kWays = 40;
    Random random{kSeed};
    int apart = 0;
    int round = 0;
    for (int i = 0; i < property_cases(60); ++i) {
        const RegionOffset walls{random_region(random)};
        const Region2d region = walls.at(uniform(random, 1.0, 12.0));
        for (int k = 0; k < kWays && !region.contours.empty(); ++k) {
            const Vec2d from = random_place(random, region);
            const Vec2d to = random_place(random, region);
            const std::vector<Edge> way = path_inside_region(region, from, to);
            LONGS_EQUAL(part_of(region, from) == part_of(region, to), !way.empty());
            if (way.empty()) {
                ++apart;
                continue;
            }
            round += way.size() > 1 ? 1 : 0;
            check_way(region, way, from, to);
        }
    }
    std::printf("seed %u: %d places apart, %d ways round walls\n", kSeed, apart, round);
    CHECK(apart > 0 && round > 0);
}

TEST(PathInsideRegion, GoesTheShorterWayRoundAnIsland)
{
    const Contour square{line_edge({-20, -20}, {20, -20}), line_edge({20, -20}, {20, 20}),
                         line_edge({20, 20}, {-20, 20}), line_edge({-20, 20}, {-20, -20})};
    const Contour island{line_edge({-3, -1}, {-3, 5}), line_edge({-3, 5}, {3, 5}),
                         line_edge({3, 5}, {3, -1}), line_edge({3, -1}, {-3, -1})};
    const std::vector<Edge> way = path_inside_region({{square, island}}, {-10, 0}, {10, 0});
    LONGS_EQUAL(5, way.size());
    DOUBLES_EQUAL(22.0, length(way), 1e-9);
}

}  // namespace
}  // namespace cusp::test
