// Allowed positions of the axis, compared with distances by brute force.
#include "host_tools/cam/hull_rough/clear_zone.hpp"

#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/hull_rough/zigzag.hpp"

using namespace cusp;
using namespace cusp::hull_rough;

namespace {

constexpr Rectangle kField{0, 0, 100, 60};

std::vector<Rectangle> random_boxes(std::mt19937& random, int count)
{
    std::uniform_real_distribution<double> x{-5, 100};
    std::uniform_real_distribution<double> y{-5, 60};
    std::uniform_real_distribution<double> size{0.5, 12};
    std::vector<Rectangle> boxes;
    for (int i = 0; i < count; ++i) {
        const Vec2d at{x(random), y(random)};
        boxes.push_back({at.x, at.y, at.x + size(random), at.y + size(random)});
    }
    return boxes;
}

double nearest(const std::vector<Rectangle>& boxes, Vec2d p)
{
    double least = 1e300;
    for (const Rectangle& box : boxes) {
        least = std::min(least, distance(p, p, box));
    }
    return least;
}

}  // namespace

TEST_GROUP(ClearZone){};

TEST(ClearZone, EndsAStretchWhereTheCutterTouchesACorner)
{
    const ClearZone zone{{{40, 0, 60, 10}}, kField, 5};
    const auto stretches = zone.on_line(13);
    LONGS_EQUAL(2, stretches.size());
    DOUBLES_EQUAL(40 - 4, stretches[0].end, 1e-12);
    DOUBLES_EQUAL(60 + 4, stretches[1].begin, 1e-12);
}

TEST(ClearZone, SeesABoxThatAMoveOnlySweepsOver)
{
    const ClearZone zone{{{40, 20, 41, 21}}, kField, 3};
    CHECK_FALSE(zone.clear({30, 23}, {50, 23}));
    CHECK(zone.clear({30, 24.5}, {50, 24.5}));
}

TEST(ClearZone, KeepsTheRadiusFromEveryBoxOnRandomOnes)
{
    constexpr unsigned kSeed = 7;
    std::printf("ClearZone seed %u\n", kSeed);
    std::mt19937 random{kSeed};
    for (int round = 0; round < 200; ++round) {
        const auto boxes = random_boxes(random, 3 + round % 20);
        const ClearZone zone{boxes, kField, 3};
        for (const Chain& chain : zigzag_chains(zone, zigzag_layout(0, 60, 6))) {
            for (std::size_t i = 1; i < chain.size(); ++i) {
                for (int k = 0; k <= 40; ++k) {
                    const Vec2d p = chain[i - 1] + (chain[i] - chain[i - 1]) * (k / 40.0);
                    CHECK(nearest(boxes, p) >= 3 - 1e-9);
                }
            }
        }
    }
}

TEST(ClearZone, CoversEveryStretchOfEveryLineOnce)
{
    std::mt19937 random{11};
    const auto boxes = random_boxes(random, 12);
    const ClearZone zone{boxes, kField, 3};
    const ZigzagLayout layout = zigzag_layout(0, 60, 6);
    double expected = 0;
    for (int i = 0; i < layout.lines; ++i) {
        for (const Interval s : zone.on_line(layout.first_line + i * layout.spacing)) {
            expected += s.end - s.begin;
        }
    }
    double level = 0;
    for (const Chain& chain : zigzag_chains(zone, layout)) {
        // Lines along y link the stretches; a horizontal link only goes back over its line.
        for (std::size_t i = 1; i < chain.size(); ++i) {
            level += chain[i].y == chain[i - 1].y ? std::abs(chain[i].x - chain[i - 1].x) : 0;
        }
    }
    CHECK(level >= expected - 1e-9);
}
