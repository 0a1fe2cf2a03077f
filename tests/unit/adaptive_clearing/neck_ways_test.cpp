#include "host_tools/cam/adaptive_clearing/neck_ways.hpp"

#include <algorithm>
#include <cmath>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

namespace {

// For a tool of radius 3: necks of 6.14 to 9.1 mm, with mouths of up to 10.8 mm.
constexpr NeckLimits kLimits{3.01, 0.06, 1.54, 2.4, 0.3};

Region2d polygon(const std::vector<Vec2d>& points)
{
    Contour contour;
    for (std::size_t i = 0; i < points.size(); ++i) {
        contour.push_back(line_edge(points[i], points[(i + 1) % points.size()]));
    }
    return {{contour}};
}

std::vector<NeckWay> ways_of(const Region2d& region)
{
    const RegionOffset walls{region};
    return neck_ways(walls, kLimits);
}

TEST_GROUP(NeckWays){};

TEST(NeckWays, ASlotHasItsMiddle)
{
    const std::vector<NeckWay> ways = ways_of(polygon({{0, 0}, {60, 0}, {60, 7}, {0, 7}}));
    LONGS_EQUAL(2, ways.size());
    double least = 1e9;
    double most = -1e9;
    for (const NeckPlace& place : ways.front()) {
        if (place.centre.x < 3.5 || place.centre.x > 56.5) {
            continue;  // in the corners
        }
        DOUBLES_EQUAL(3.5, place.centre.y, 1e-4);
        DOUBLES_EQUAL(0.49, place.room, 1e-4);
        least = std::min(least, place.centre.x);
        most = std::max(most, place.centre.x);
    }
    CHECK(least < 4.0);
    CHECK(most > 56.0);
}

// Around a corner between two slots the way continues.
TEST(NeckWays, AWayTurnsWithItsSlot)
{
    const std::vector<NeckWay> ways =
        ways_of(polygon({{0, 0}, {40, 0}, {40, 30}, {33, 30}, {33, 7}, {0, 7}}));
    CHECK(std::any_of(ways.begin(), ways.end(), [](const NeckWay& way) {
        const auto reaches = [&](Vec2d place) {
            return std::any_of(way.begin(), way.end(),
                               [&](const NeckPlace& p) { return norm(p.centre - place) < 0.3; });
        };
        return reaches({10, 3.5}) && reaches({36.5, 20});
    }));
}

// What two boolean operations have left of a level: a sliver whose arc runs into its sides at no angle. Circles from its
// walls reached over the ground between it and the next loop.
TEST(NeckWays, ASliverHasNoNeckBesideItself)
{
    const Vec2d a{0.078066963, 0.204894427};
    const Vec2d b{0.201462283, 0.410135215};
    const Vec2d c{0.106074190, 0.501663626};
    const Vec2d d{0.089615142, 0.492977881};
    const Contour sliver{line_edge(a, b), line_edge(b, c),
                         arc_edge(c, d, {2.616976631, -4.276306712}, 1),
                         arc_edge(d, a, {-0.179042175, 0.359474151}, -1)};
    Region2d region =
        polygon({{-3, -4}, {-0.314601897, -0.448223260}, {-0.372526743, -0.069309816}, {-1, -0.5}});
    region.contours.push_back(sliver);
    const RegionOffset walls{region};
    for (const NeckWay& way : neck_ways(walls, {0.002, 0.02, 0.54, 0.85, 0.105})) {
        for (const NeckPlace& place : way) {
            CHECK(walls.contains(place.centre));
            CHECK(walls.nearest(place.centre, kUnbounded) > place.room);
        }
    }
}

TEST(NeckWays, RoomsAndTheirCornersHaveNone)
{
    LONGS_EQUAL(0, ways_of(polygon({{0, 0}, {60, 0}, {60, 40}, {0, 40}})).size());
    LONGS_EQUAL(0, ways_of(polygon({{0, 0}, {60, 0}, {60, 9.5}, {0, 9.5}})).size());
    // A star's tip of 45 degrees.
    LONGS_EQUAL(0, ways_of(polygon({{0, 0}, {60, -25}, {60, 25}})).size());
}

TEST(NeckWays, WhereNoToolFitsIsNone)
{
    LONGS_EQUAL(0, ways_of(polygon({{0, 0}, {60, 0}, {60, 6.1}, {0, 6.1}})).size());
}

TEST(NeckWays, ANeckBetweenRoomsHasItsMouths)
{
    const std::vector<NeckWay> ways = ways_of(polygon({{0, 0},
                                                       {25, 0},
                                                       {25, 11.5},
                                                       {50, 11.5},
                                                       {50, 0},
                                                       {75, 0},
                                                       {75, 30},
                                                       {50, 30},
                                                       {50, 18.5},
                                                       {25, 18.5},
                                                       {25, 30},
                                                       {0, 30}}));
    LONGS_EQUAL(2, ways.size());
    for (const NeckWay& way : ways) {
        const double from = std::min(way.front().centre.x, way.back().centre.x);
        const double to = std::max(way.front().centre.x, way.back().centre.x);
        CHECK(from < 22.5);
        CHECK(to > 52.5);
        for (const NeckPlace& place : way) {
            DOUBLES_EQUAL(15.0, place.centre.y, 1e-3);
            CHECK(place.room <= kLimits.most_room_beside);
        }
    }
}

}  // namespace

}  // namespace cusp::test
