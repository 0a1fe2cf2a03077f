// Offsets of random regions, judged by brute-force distance and by Clipper.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "host_tools/geometry/offset/edge_reach.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/judges/offset_judge.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace offset;

namespace {

constexpr int kRegions = 10000;  // source profiles tried

TEST_GROUP(RandomOffset){};

TEST(RandomOffset, KeepsItsDistanceAndMissesNothing)
{
    constexpr unsigned kSeed = 20260;
    Random random{kSeed};
    int offsets = 0;
    for (int i = 0; i < property_cases(kRegions); ++i) {
        const Region2d source = random_region(random);
        const RegionOffset kernel{source};
        for (int k = 0; k < 4; ++k) {
            const bool whole = uniform(random, 0.0, 1.0) < 0.3;
            const double any = uniform(random, 0.2, 14.0);
            const double distance = whole ? std::max(0.5, std::round(any * 2.0) / 2.0) : any;
            const Region2d result = kernel.at(distance);
            const double worst = worst_distance(source, result, distance);
            const int wrong = wrong_points(random, source, result, distance);
            if (worst > 1e-6 || wrong > 0) {
                std::printf("seed %u case %d distance %.9g: worst %.3g mm, %d wrong points\n",
                            kSeed, i, distance, worst, wrong);
            }
            CHECK(worst <= 1e-6);
            LONGS_EQUAL(0, wrong);
            ++offsets;
        }
    }
    LONGS_EQUAL(4 * property_cases(kRegions), offsets);
}

// A circle of many short lines and arcs: at a distance of many of their lengths each raw piece
// crosses many others, which the kernel trims first.
Region2d rough_circle(Random& random, int count)
{
    Contour contour;
    std::vector<Vec2d> corners;
    for (int i = 0; i < count; ++i) {
        const double angle = 6.283185307179586 * i / count;
        const double out = 50.0 + uniform(random, -120.0, 120.0) / count;
        corners.push_back({out * std::cos(angle), out * std::sin(angle)});
    }
    for (int i = 0; i < count; ++i) {
        const Vec2d a = corners[static_cast<std::size_t>(i)];
        const Vec2d b = corners[static_cast<std::size_t>((i + 1) % count)];
        const double side = uniform(random, 0.0, 1.0);
        const Vec2d out = left_normal(b - a) * uniform(random, 0.8, 2.0);
        contour.push_back(side < 0.4   ? line_edge(a, b)
                          : side < 0.7 ? arc_edge(a, b, (a + b) * 0.5 + out, 1)
                                       : arc_edge(a, b, (a + b) * 0.5 - out, -1));
    }
    return {{contour}};
}

TEST(RandomOffset, OfManySmallCurvesMissesNothing)
{
    constexpr unsigned kSeed = 808;
    Random random{kSeed};
    for (int i = 0; i < property_cases(kRegions) / 500; ++i) {
        Region2d source = rough_circle(random, static_cast<int>(uniform(random, 150.0, 600.0)));
        if (i % 2 == 0) {
            source.contours.push_back(reversed(random_star(random, {5.0, 3.0}, 12.0, 5, 0.0)));
        }
        const RegionOffset kernel{source};
        for (int k = 0; k < 4; ++k) {
            const double distance = uniform(random, 1.0, 48.0);
            const Region2d result = kernel.at(distance);
            CHECK(worst_distance(source, result, distance) <= 1e-6);
            LONGS_EQUAL(0, wrong_points(random, source, result, distance));
        }
    }
}

TEST(RandomOffset, EnclosesTheAreaThatClipperFinds)
{
    constexpr unsigned kSeed = 4711;
    Random random{kSeed};
    for (int i = 0; i < property_cases(kRegions) / 20; ++i) {
        const Region2d source = random_region(random);
        const RegionOffset kernel{source};
        const double distance = uniform(random, 0.5, 10.0);
        const Region2d result = kernel.at(distance);
        double mine = 0.0;
        double border = 1.0;
        for (const Contour& contour : result.contours) {
            mine += area(contour);
            border += length(contour);
        }
        // Clipper's arcs and the chords of ours both stay within some 3 um.
        DOUBLES_EQUAL(clipper_area(source, distance), mine, 0.02 + 0.005 * border);
    }
}

TEST(RandomOffset, TakenInStepsEqualsOneOffset)
{
    constexpr unsigned kSeed = 99;
    Random random{kSeed};
    for (int i = 0; i < property_cases(kRegions) / 20; ++i) {
        const Region2d source = random_region(random);
        const RegionOffset kernel{source};
        const double distance = uniform(random, 1.0, 8.0);
        const Region2d half = kernel.at(0.5 * distance);
        const Region2d chained = RegionOffset{half}.at(0.5 * distance);
        const Region2d direct = kernel.at(distance);
        LONGS_EQUAL(0, wrong_points(random, source, chained, distance));
        CHECK(worst_distance(source, direct, distance) <= 1e-6);
        CHECK(worst_distance(source, chained, distance) <= 4e-6);
    }
}

// The overlay that at() falls back on.
TEST(RandomOffset, EqualsTheRegionWithoutWhatIsTooNear)
{
    constexpr unsigned kSeed = 5;
    Random random{kSeed};
    for (int i = 0; i < property_cases(kRegions) / 20; ++i) {
        const Region2d source = random_region(random);
        const double distance = uniform(random, 0.2, 14.0);
        const Region2d result = without(source, edge_reach(source, distance));
        const double worst = worst_distance(source, result, distance);
        const int wrong = wrong_points(random, source, result, distance);
        if (worst > 4e-6 || wrong > 0) {
            std::printf("seed %u case %d distance %.9g: worst %.3g mm, %d wrong points\n", kSeed, i,
                        distance, worst, wrong);
        }
        CHECK(worst <= 4e-6);
        LONGS_EQUAL(0, wrong);
    }
}

// Two or three boxes on a grid, side by side, corner to corner or apart; none overlap.
Region2d boxes_that_touch(Random& random)
{
    Region2d boxes;
    double x = 0.0;
    double y = 0.0;
    for (int k = static_cast<int>(uniform(random, 2.0, 4.0)); k > 0; --k) {
        const double right = x + std::ceil(uniform(random, 0.0, 4.0)) * 5.0;
        const double top = y + std::ceil(uniform(random, 0.0, 4.0)) * 5.0;
        boxes.contours.push_back({line_edge({x, y}, {right, y}),
                                  line_edge({right, y}, {right, top}),
                                  line_edge({right, top}, {x, top}), line_edge({x, top}, {x, y})});
        x = right;
        y = top - std::floor(uniform(random, 0.0, 3.0)) * 5.0;
    }
    return boxes;
}

TEST(RandomOffset, OfOutsidesThatTouchKeepsItsDistanceAndMissesNothing)
{
    constexpr unsigned kSeed = 77;
    Random random{kSeed};
    for (int i = 0; i < property_cases(kRegions) / 10; ++i) {
        const Region2d source = reversed(boxes_that_touch(random));
        const RegionOffset kernel{source};
        const bool grid = uniform(random, 0.0, 1.0) < 0.5;
        const double distance =
            grid ? std::ceil(uniform(random, 0.0, 8.0)) * 1.25 : uniform(random, 0.2, 12.0);
        const Region2d result = kernel.at(distance);
        const double worst = worst_distance(source, result, distance, true);
        const int wrong = wrong_points(random, source, result, distance, 15.0, true);
        if (worst > 4e-6 || wrong > 0) {
            std::printf("seed %u case %d distance %.9g: worst %.3g mm, %d wrong points\n", kSeed, i,
                        distance, worst, wrong);
        }
        CHECK(worst <= 4e-6);
        LONGS_EQUAL(0, wrong);
    }
}

}  // namespace
}  // namespace cusp::test
