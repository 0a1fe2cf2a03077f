#include "host_tools/geometry/offset/contour_fit.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace nurbs;
using namespace offset;

namespace {

Curve quarter_circle()
{
    return {2,
            {0.0, 0.0, 0.0, 1.0, 1.0, 1.0},
            {{10.0, 0.0, 0.0}, {10.0, 10.0, 0.0}, {0.0, 10.0, 0.0}},
            {1.0, std::sqrt(0.5), 1.0}};
}

Curve wave()
{
    return {3,
            {0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0},
            {{0.0, 0.0, 0.0}, {20.0, 30.0, 0.0}, {40.0, -30.0, 0.0}, {60.0, 0.0, 0.0}},
            {1.0, 1.0, 1.0, 1.0}};
}

TEST_GROUP(ContourFit){};

TEST(ContourFit, KeepsACircleAnExactArc)
{
    const std::vector<Edge> edges = fit_edges(quarter_circle(), 0.01);
    LONGS_EQUAL(1, edges.size());
    DOUBLES_EQUAL(10.0, edges[0].radius, 1e-12);
    DOUBLES_EQUAL(0.0, edges[0].centre.x, 1e-12);
    LONGS_EQUAL(1, edges[0].turn);
}

TEST(ContourFit, StaysWithinToleranceOfAFreeCurve)
{
    for (const double tolerance : {0.1, 0.01, 0.001, 1e-5}) {
        const std::vector<Edge> edges = fit_edges(wave(), tolerance);
        double worst = 0.0;
        for (int i = 0; i <= 5000; ++i) {
            const Vec3d p = point_at(wave(), i / 5000.0);
            double best = 1e300;
            for (const Edge& edge : edges) {
                best = std::min(best, distance_to(edge, {p.x, p.y}));
            }
            worst = std::max(worst, best);
        }
        CHECK(worst <= tolerance);
    }
}

TEST(ContourFit, JoinsTheArcsOfAFreeCurveWithACommonTangent)
{
    const std::vector<Edge> edges = fit_edges(wave(), 0.001);
    CHECK(edges.size() > 4);
    for (std::size_t i = 1; i < edges.size(); ++i) {
        CHECK(distance(edges[i - 1].end, edges[i].start) < 1e-12);
        CHECK(std::abs(cross(tangent_at_end(edges[i - 1]), tangent_at_start(edges[i]))) < 1e-6);
    }
}

TEST(ContourFit, ClosesAGapOfTheFileWithALine)
{
    Curve back = reversed(wave());
    back.points[1].y = -60.0;
    back.points[2].y = -60.0;
    back.points[0].y = 5e-4;
    const Contour contour = fit_contour({wave(), back}, 0.01);
    for (std::size_t i = 0; i < contour.size(); ++i) {
        CHECK(distance(contour[i].end, contour[(i + 1) % contour.size()].start) < 1e-12);
    }
}

}  // namespace
}  // namespace cusp::test
