// Extents of parts: trims and control points that stand off the surface do not count.
#include "host_tools/job/import/part_extent.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/import.hpp"
#include "tests/support/example_parts.hpp"
#include "tests/support/plates.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::nurbs;
using namespace cusp::test;

namespace {

void check_near(Vec3d expected, Vec3d found, double tolerance)
{
    DOUBLES_EQUAL(expected.x, found.x, tolerance);
    DOUBLES_EQUAL(expected.y, found.y, tolerance);
    DOUBLES_EQUAL(expected.z, found.z, tolerance);
}

}  // namespace

TEST_GROUP(PartExtent){};

TEST(PartExtent, OfSurfacesHoldsAllOfThem)
{
    const PartExtent box = extent_of_surfaces({plate(0, 5, 10, 20, -3), plate(8, -2, 30, 10, 4)});
    check_near({0, -2, -3}, box.low, 2e-6);
    check_near({30, 20, 4}, box.high, 2e-6);
}

TEST(PartExtent, OfACurvedSurfaceIsThatOfItsPointsNotOfItsControlPoints)
{
    const std::vector<Surface> hills = read_surfaces(kExampleParts + "sine-hills.json");
    double highest = -1e9;
    double lowest = 1e9;
    for (int i = 0; i <= 400; ++i) {
        for (int j = 0; j <= 400; ++j) {
            const Surface& s = hills.front();
            const double u = s.u_begin() + (s.u_end() - s.u_begin()) * i / 400;
            const double v = s.v_begin() + (s.v_end() - s.v_begin()) * j / 400;
            highest = std::max(highest, point_at(s, u, v).z);
            lowest = std::min(lowest, point_at(s, u, v).z);
        }
    }
    const PartExtent box = extent_of_surfaces(hills);
    CHECK(box.high.z >= highest - 2e-6 && box.high.z < highest + 0.01);
    CHECK(box.low.z <= lowest + 2e-6 && box.low.z > lowest - 0.01);
}

// The right half of a plate, cut off along u = 1/2.
TEST(PartExtent, WhatTrimsCutOffDoesNotCount)
{
    Surface half = plate(0, 0, 20, 10, 1);
    Curve edge;
    edge.degree = 1;
    edge.knots = {0, 0, 1, 2, 3, 4, 4};
    edge.points = {{0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0}, {0.5, 0, 0}};
    edge.weights.assign(5, 1.0);
    half.trims = {{edge}};
    const PartExtent box = extent_of_surfaces({half});
    check_near({10, 0, 1}, box.low, 2e-4);
    check_near({20, 10, 1}, box.high, 2e-4);
}

TEST(PartExtent, OfTrianglesIsThatOfTheirCorners)
{
    const PartExtent box = extent_of_triangles({{{{1, 2, 3}, {4, 0, 3}, {1, 5, -6}}}});
    check_near({1, 0, -6}, box.low, 0.0);
    check_near({4, 5, 3}, box.high, 0.0);
    const PartExtent both = joined(box, {{0, 1, 0}, {2, 9, 1}});
    check_near({0, 0, -6}, both.low, 0.0);
    check_near({4, 9, 3}, both.high, 0.0);
}
