// Distances from walls with closed forms.
#include "host_tools/judge/verify/wall_distance.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/job/loop_shape.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::verify;

namespace {

Loop square()
{
    return {{1,
             {0, 0, 1, 2, 3, 4, 4},
             {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0}},
             {1, 1, 1, 1, 1}}};
}

// Of every chord, one by one.
double distance_from_chords(const std::vector<Vec2d>& line, Vec2d p, double cap)
{
    double nearest = cap;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const Vec2d along = line[k + 1] - line[k];
        const double squared = dot(along, along);
        const double foot =
            squared > 0 ? std::clamp(dot(p - line[k], along) / squared, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, norm(p - (line[k] + foot * along)));
    }
    return nearest;
}

}  // namespace

TEST_GROUP(WallDistance){};

TEST(WallDistance, IsPositiveInsideABoundary)
{
    const WallDistance wall{square(), true, 6};
    DOUBLES_EQUAL(2, wall.at(5, 2), 1e-12);
    DOUBLES_EQUAL(-1, wall.at(5, -1), 1e-12);
    DOUBLES_EQUAL(5, wall.at(5, 5), 1e-12);
    DOUBLES_EQUAL(-6, wall.at(300, 300), 0);
}

TEST(WallDistance, IsPositiveOutsideAnIsland)
{
    const WallDistance wall{square(), false, 6};
    DOUBLES_EQUAL(-2, wall.at(5, 2), 1e-12);
    DOUBLES_EQUAL(5, wall.at(13, 14), 1e-12);
    DOUBLES_EQUAL(6, wall.at(-300, 5), 0);
}

TEST(WallDistance, IsThatOfTheNearestChord)
{
    constexpr double kCap = 3;
    std::mt19937 random{4711};
    std::uniform_real_distribution<double> place{-3, 13};
    for (int wave = 0; wave < 5; ++wave) {
        Loop loop{{2, {0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1}, {}, {1, 1, 1, 1, 1, 1}}};
        for (int k = 0; k < 5; ++k) {
            loop[0].points.push_back({place(random), place(random), 0});
        }
        loop[0].points.push_back(loop[0].points.front());
        const std::vector<Vec2d> line = loop_polyline(loop, kWallChord);
        const WallDistance wall{loop, true, kCap};
        int near = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec2d p{place(random), place(random)};
            const double distance = distance_from_chords(line, p, kCap);
            DOUBLES_EQUAL(distance, std::abs(wall.at(p.x, p.y)), 0);
            near += distance < kCap ? 1 : 0;
        }
        CHECK(near > 200);
    }
}
