// Intersections of plates and domes.
#include "host_tools/geometry/part_model/model_intersection.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/trim_region.hpp"
#include "tests/support/plates.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace nurbs;
using namespace part_model;

namespace {

constexpr double kSectionEdgeError = 1e-4;  // mm

// z = top - (x^2 + y^2) / 10 over [-10, 10] x [-10, 10].
Surface dome(double top)
{
    Surface s;
    s.degree_u = s.degree_v = 2;
    s.size_u = s.size_v = 3;
    s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
    // x^2 over [-10, 10] has the Bernstein coefficients 100, -100, 100
    constexpr double kSquares[]{100, -100, 100};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            s.points.push_back(
                {10.0 * (i - 1), 10.0 * (j - 1), top - (kSquares[i] + kSquares[j]) / 10});
            s.weights.push_back(1);
        }
    }
    return s;
}

double area(const Surface& s)
{
    double sum = 0;
    const TrimRegion region{s, kSectionEdgeError};
    for (const std::vector<Vec2d>& loop : region.loops()) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            sum += 0.5 * cross(loop[i], loop[(i + 1) % loop.size()]);
        }
    }
    return sum;
}

}  // namespace

TEST_GROUP(ModelIntersection){};

TEST(ModelIntersection, APlateUnderADomeIsCutRound)
{
    const auto left =
        intersection_of({{plate(-10, -10, 10, 10, 0)}, {dome(2.5)}}, kSectionEdgeError);
    LONGS_EQUAL(2, left.size());
    // they meet where x^2 + y^2 = 25: inside the plate is lower
    LONGS_EQUAL(1, left[0].trims.size());
    double worst = 0;
    const TrimRegion region{left[0], kSectionEdgeError};
    const auto edges = region.edges(left[0]);
    LONGS_EQUAL(1, edges.size());
    const std::vector<Vec3d>& loop = edges.front();
    CHECK(loop.size() > 10);
    for (std::size_t k = 0; k + 1 < loop.size(); ++k) {
        const Vec3d middle = 0.5 * (loop[k] + loop[k + 1]);
        worst = std::max({worst, std::abs(std::hypot(loop[k].x, loop[k].y) - 5),
                          std::abs(std::hypot(middle.x, middle.y) - 5)});
    }
    CHECK(worst < 2 * kSectionEdgeError);
    // outside the dome: its border and a hole
    LONGS_EQUAL(2, left[1].trims.size());
    DOUBLES_EQUAL(1 - 3.141592653589793 * 25 / 400, area(left[1]), 1e-4);
}

TEST(ModelIntersection, WholeSurfacesStayAsTheyAreHiddenOnesGo)
{
    Surface low = plate(-10, -10, 10, 10, -30);
    const auto left = intersection_of({{low}, {dome(2.5)}});
    LONGS_EQUAL(1, left.size());
    CHECK(left[0].trims.empty());
    DOUBLES_EQUAL(-30, left[0].points[0].z, 0);
}

TEST(ModelIntersection, ThereIsNothingBesideAModel)
{
    const auto left = intersection_of({{plate(0, 0, 10, 10, 0)}, {plate(4, 4, 30, 30, 5)}});
    LONGS_EQUAL(1, left.size());
    // bodies are 0.0002 mm wider, so that they may share an edge
    DOUBLES_EQUAL(0.60002 * 0.60002, area(left[0]), 1e-6);
    LONGS_EQUAL(0, intersection_of({{plate(0, 0, 10, 10, 0)}, {plate(20, 0, 30, 10, 5)}}).size());
}

TEST(ModelIntersection, AModelOfSeveralSurfacesIsTheirUnion)
{
    // two plates, the higher one counts where they overlap
    const auto left = intersection_of(
        {{plate(0, 0, 10, 10, 0)}, {plate(0, 0, 10, 10, -1), plate(0, 0, 5, 10, 1)}});
    LONGS_EQUAL(2, left.size());
    DOUBLES_EQUAL(0.5, area(left[0]), 1e-4);
    DOUBLES_EQUAL(-1, left[1].points[0].z, 0);
}

TEST(ModelIntersection, ANarrowStripIsFound)
{
    // a ridge 0.1 mm wide at the plate's height, oblique to the samples
    Surface ridge;
    ridge.degree_u = 1;
    ridge.degree_v = 2;
    ridge.size_u = 2;
    ridge.size_v = 3;
    ridge.knots_u = {0, 0, 1, 1};
    ridge.knots_v = {0, 0, 0, 1, 1, 1};
    constexpr double kHeights[]{1, -1.0001, 1};  // least -0.00005
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 3; ++j) {
            ridge.points.push_back({20.0 * i, 10.0 * j + 3.0 * i, kHeights[j]});
            ridge.weights.push_back(1);
        }
    }
    const auto left = intersection_of({{plate(0, 3, 20, 20, 0)}, {ridge}});
    LONGS_EQUAL(2, left.size());
    // z = 4.0002 (v - 0.5)^2 - 0.00005; differences of 0.00001 count as equal
    DOUBLES_EQUAL(2 * std::sqrt(0.00006 / 4.0002), area(left[1]), 3e-5);
}

}  // namespace cusp::test
