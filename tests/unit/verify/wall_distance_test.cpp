// Distances from walls with closed forms.
#include "host_tools/judge/verify/wall_distance.hpp"

#include "CppUTest/TestHarness.h"

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
