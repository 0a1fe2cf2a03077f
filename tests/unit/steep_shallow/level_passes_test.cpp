// Levels: how far apart they are, and the way down along them.
#include "host_tools/cam/steep_shallow/level_passes.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/steep_shallow/level_spiral.hpp"

using namespace cusp;
using namespace cusp::steep_shallow;

namespace {

// A square loop whose sides allow these steps.
LevelLoop square(double z, double half, std::vector<double> steps)
{
    LevelLoop loop;
    constexpr int kEach = 10;
    const Vec2d corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t side = 0; side < 4; ++side) {
        for (int k = 0; k < kEach; ++k) {
            const Vec2d a = corners[side];
            const Vec2d b = corners[(side + 1) % 4];
            const Vec2d at = (a + (b - a) * (k / double{kEach})) * half;
            loop.places.push_back({{at.x, at.y, z}, steps[side % steps.size()], true});
        }
    }
    return loop;
}

}  // namespace

TEST_GROUP(LevelPasses){};

TEST(LevelPasses, AreAsFarApartAsGroundOfOneSlopeAllows)
{
    DOUBLES_EQUAL(0.7, step_down({square(0, 5, {0.7})}, 1.0), 1e-12);
}

// Three sides of four at 1.0, with one level more over the fourth: (3 + 2) / 1.0 against 4 / 0.6.
TEST(LevelPasses, AreNotAsCloseAsAShortStretchAsks)
{
    DOUBLES_EQUAL(1.0, step_down({square(0, 5, {1.0, 1.0, 1.0, 0.6})}, 1.0), 1e-12);
}

// One side of four at 1.0: (1 + 3 * 2) / 1.0 against 4 / 0.6.
TEST(LevelPasses, AreAsCloseAsMostOfTheGroundAsks)
{
    DOUBLES_EQUAL(0.6, step_down({square(0, 5, {1.0, 0.6, 0.6, 0.6})}, 1.0), 1e-12);
}

TEST(LevelPasses, AreWidestWhereNoGroundIsInTheArea)
{
    LevelLoop loop = square(0, 5, {0.5});
    for (LevelPlace& place : loop.places) {
        place.in_area = false;
    }
    DOUBLES_EQUAL(0.8, step_down({loop}, 0.8), 1e-12);
}

TEST(LevelPasses, OfAPartOfALoopAreOpen)
{
    LevelLoop loop = square(0, 5, {0.5});
    loop.places[0].in_area = false;
    loop.places[20].in_area = false;
    const std::vector<LevelRun> runs = runs_of({loop});
    LONGS_EQUAL(2, runs.size());
    LONGS_EQUAL(19, runs[0].size());
    LONGS_EQUAL(19, runs[1].size());
    DOUBLES_EQUAL(0, norm(runs[0].front() - loop.places[1].tip), 1e-12);
    DOUBLES_EQUAL(0, norm(runs[1].back() - loop.places[39].tip), 1e-12);
}

TEST(LevelPasses, OfAWholeLoopEndWhereTheyBegin)
{
    const std::vector<LevelRun> runs = runs_of({square(0, 5, {0.5})});
    LONGS_EQUAL(1, runs.size());
    DOUBLES_EQUAL(0, norm(runs[0].back() - runs[0].front()), 1e-12);
}
