#include "host_tools/geometry/offset/shadow.hpp"

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::test {

using namespace offset;

namespace {

using Triangles = std::vector<std::array<Vec3d, 3>>;

void add_quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, Triangles& out)
{
    out.push_back({a, b, c});
    out.push_back({a, c, d});
}

// A box from z = 0 with all six sides.
void add_box(double x0, double y0, double x1, double y1, double top, Triangles& out)
{
    add_quad({x0, y0, top}, {x1, y0, top}, {x1, y1, top}, {x0, y1, top}, out);
    add_quad({x0, y0, 0}, {x0, y1, 0}, {x1, y1, 0}, {x1, y0, 0}, out);
    add_quad({x0, y0, 0}, {x1, y0, 0}, {x1, y0, top}, {x0, y0, top}, out);
    add_quad({x1, y0, 0}, {x1, y1, 0}, {x1, y1, top}, {x1, y0, top}, out);
    add_quad({x1, y1, 0}, {x0, y1, 0}, {x0, y1, top}, {x1, y1, top}, out);
    add_quad({x0, y1, 0}, {x0, y0, 0}, {x0, y0, top}, {x0, y1, top}, out);
}

// A cone of 45 degrees, of facets around its axis.
Triangles cone(double radius, int facets)
{
    Triangles out;
    const auto at = [&](int k) {
        const double turn = 2 * kPi * k / facets;
        return Vec3d{radius * elementary::cos(turn), radius * elementary::sin(turn), 0};
    };
    for (int k = 0; k < facets; ++k) {
        out.push_back({at(k), at((k + 1) % facets), {0, 0, radius}});
    }
    return out;
}

TEST_GROUP(Shadow)
{
    Triangles stairs;

    void setup() override
    {
        add_box(0, 0, 30, 20, 5, stairs);
        add_box(10, 5, 20, 15, 12, stairs);
    }
};

TEST(Shadow, OfABoxIsItsRectangle)
{
    Triangles box;
    add_box(-3, 2, 7, 6, 4, box);
    const Region2d shadow = shadow_above(box, 1);
    LONGS_EQUAL(1, shadow.contours.size());
    LONGS_EQUAL(4, shadow.contours.front().size());
    DOUBLES_EQUAL(40, area(shadow), 1e-9);
}

TEST(Shadow, TakesWhatIsHigherAlone)
{
    DOUBLES_EQUAL(600, area(shadow_above(stairs, 4.9)), 1e-6);
    DOUBLES_EQUAL(100, area(shadow_above(stairs, 5)),
                  1e-6);  // level ground at the height stands not above it
    DOUBLES_EQUAL(0, area(shadow_above(stairs, 12)), 1e-6);
}

TEST(Shadow, CutsSlantedTrianglesAtTheHeight)
{
    constexpr int kFacets = 720;
    for (const double z : {0.0, 2.5, 7.999}) {
        const double radius = 10 - (z + kStandsAbove);
        DOUBLES_EQUAL(kPi * radius * radius, area(shadow_above(cone(10, kFacets), z)), 0.01);
        LONGS_EQUAL(1, shadow_above(cone(10, kFacets), z).contours.size());
    }
}

TEST(Shadow, OfLevelGroundHasWhatStandsOnItAsAHole)
{
    const Region2d floor = level_ground(stairs, 5);
    LONGS_EQUAL(2, floor.contours.size());
    DOUBLES_EQUAL(500, area(floor), 1e-6);
    DOUBLES_EQUAL(100, area(level_ground(stairs, 12)), 1e-6);
    DOUBLES_EQUAL(0, area(level_ground(stairs, 0)), 1e-6);  // the underside is not seen from above
}

TEST(Shadow, KnowsTheHeightsOfLevelGround)
{
    const auto heights = level_heights(stairs);
    LONGS_EQUAL(2, heights.size());
    DOUBLES_EQUAL(5, heights[0].z, 0);
    DOUBLES_EQUAL(500, heights[0].area, 1e-6);
    DOUBLES_EQUAL(12, heights[1].z, 0);
    LONGS_EQUAL(0, level_heights(cone(10, 90)).size());
}

TEST(Shadow, IsTheSameForTrianglesOfEitherSense)
{
    Triangles turned = stairs;
    for (std::size_t k = 0; k < turned.size(); k += 3) {
        std::swap(turned[k][1], turned[k][2]);
    }
    DOUBLES_EQUAL(600, area(shadow_above(turned, 1)), 1e-6);
    DOUBLES_EQUAL(500, area(level_ground(turned, 5)), 1e-6);
}

TEST(Shadow, OfNothingIsEmpty)
{
    LONGS_EQUAL(0, shadow_above({}, 0).contours.size());
    LONGS_EQUAL(0, level_heights({}).size());
}

}  // namespace
}  // namespace cusp::test
