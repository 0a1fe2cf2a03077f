// The sweep against a bitmap over all coordinates, which is simpler and as exact.
#include "host_tools/cam/hull_rough/box_union.hpp"

#include <algorithm>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

using cusp::cross;
using cusp::Vec2d;
using cusp::hull_rough::Rectangle;
using cusp::hull_rough::union_area;
using cusp::hull_rough::union_outline;

namespace {

constexpr Rectangle kEverything{-1e3, -1e3, 1e3, 1e3};

double area_of(const std::vector<std::vector<Vec2d>>& loops)
{
    double sum = 0;
    for (const auto& loop : loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            sum += cross(loop[i], loop[(i + 1) % loop.size()]) / 2;
        }
    }
    return sum;
}

// Area by coordinate compression: cells between neighbouring coordinates, covered or not.
double bitmap_area(const std::vector<Rectangle>& boxes)
{
    std::vector<double> xs;
    std::vector<double> ys;
    for (const Rectangle& b : boxes) {
        xs.insert(xs.end(), {b.x_min, b.x_max});
        ys.insert(ys.end(), {b.y_min, b.y_max});
    }
    std::sort(xs.begin(), xs.end());
    std::sort(ys.begin(), ys.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
        for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
            const bool covered = std::any_of(boxes.begin(), boxes.end(), [&](const Rectangle& b) {
                return b.x_min <= xs[i] && xs[i + 1] <= b.x_max && b.y_min <= ys[j] &&
                       ys[j + 1] <= b.y_max;
            });
            sum += covered ? (xs[i + 1] - xs[i]) * (ys[j + 1] - ys[j]) : 0;
        }
    }
    return sum;
}

bool sides_alternate(const std::vector<Vec2d>& loop)
{
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2d a = loop[i];
        const Vec2d b = loop[(i + 1) % loop.size()];
        const bool upright = a.x == b.x && a.y != b.y;
        const bool level = a.y == b.y && a.x != b.x;
        if (i % 2 == 0 ? !upright : !level) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_GROUP(BoxUnion){};

TEST(BoxUnion, OfABoxInsideAnotherIsTheOuterOne)
{
    const auto loops = union_outline({{0, 0, 10, 10}, {2, 2, 3, 3}});
    LONGS_EQUAL(1, loops.size());
    LONGS_EQUAL(4, loops[0].size());
    DOUBLES_EQUAL(100, area_of(loops), 0);
}

TEST(BoxUnion, JoinsBoxesThatShareASideWithoutIdleCorners)
{
    const auto loops = union_outline({{0, 0, 1, 1}, {1, 0, 2, 1}, {0, 1, 2, 2}});
    LONGS_EQUAL(1, loops.size());
    LONGS_EQUAL(4, loops[0].size());
}

TEST(BoxUnion, OfBoxesThatTouchInAPointIsOneLoop)
{
    const auto rising = union_outline({{0, 0, 1, 1}, {1, 1, 2, 2}});
    LONGS_EQUAL(1, rising.size());
    DOUBLES_EQUAL(2, area_of(rising), 0);
    const auto falling = union_outline({{0, 1, 1, 2}, {1, 0, 2, 1}});
    LONGS_EQUAL(1, falling.size());
    DOUBLES_EQUAL(2, area_of(falling), 0);
}

TEST(BoxUnion, RunsClockwiseAroundAHole)
{
    const auto loops = union_outline({{0, 0, 3, 1}, {0, 2, 3, 3}, {0, 0, 1, 3}, {2, 0, 3, 3}});
    LONGS_EQUAL(2, loops.size());
    DOUBLES_EQUAL(8, area_of(loops), 0);
}

TEST(BoxUnion, LeavesOutBoxesWithoutArea)
{
    LONGS_EQUAL(0, union_outline({{0, 0, 0, 5}, {1, 1, 4, 1}}).size());
}

TEST(BoxUnion, AreaIsThatOfTheWindowOnly)
{
    DOUBLES_EQUAL(1, union_area({{0, 0, 10, 10}}, {9, 9, 20, 20}), 0);
}

TEST(BoxUnion, AgreesWithABitmapOnRandomBoxes)
{
    constexpr unsigned kSeed = 20261121;
    std::printf("BoxUnion seed %u\n", kSeed);
    std::mt19937 random{kSeed};
    for (int round = 0; round < 2000; ++round) {
        // Few distinct coordinates: shared sides and corners are the rule.
        std::uniform_int_distribution<int> place{0, round % 2 == 0 ? 6 : 30};
        std::vector<Rectangle> boxes;
        for (int i = 0; i < 2 + round % 14; ++i) {
            const double x = place(random);
            const double y = place(random);
            boxes.push_back({x, y, x + place(random) % 4, y + place(random) % 4});
        }
        const double expected = bitmap_area(boxes);
        DOUBLES_EQUAL(expected, union_area(boxes, kEverything), 0);
        const auto loops = union_outline(boxes);
        DOUBLES_EQUAL(expected, area_of(loops), 0);
        for (const auto& loop : loops) {
            CHECK(sides_alternate(loop));
        }
    }
}
