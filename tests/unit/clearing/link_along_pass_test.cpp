#include "host_tools/cam/clearing/link_along_pass.hpp"

#include <algorithm>
#include <cmath>

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;
using namespace offset;

namespace {

Contour square(double half)
{
    const Vec2d p[] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    return {line_edge(p[0], p[1]), line_edge(p[1], p[2]), line_edge(p[2], p[3]),
            line_edge(p[3], p[0])};
}

// Near the square of 10 mm at its far corner only.
Contour triangle()
{
    return {line_edge({11, 11}, {30, 11}), line_edge({30, 11}, {11, 30}),
            line_edge({11, 30}, {11, 11})};
}

double way(const std::vector<Edge>& link)
{
    double sum = 0.0;
    Vec2d at = link.front().start;
    for (const Edge& edge : link) {
        DOUBLES_EQUAL(0.0, distance(at, edge.start), 1e-12);
        at = edge.end;
        sum += length(edge);
    }
    return sum;
}

TEST_GROUP(LinkAlongPass){};

TEST(LinkAlongPass, FollowsThePassBeforeToWhereTheNextIsNear)
{
    const Contour before = square(10.0);
    const std::vector<Edge> link = link_along_pass(before, triangle(), 2.0);
    DOUBLES_EQUAL(0.0, distance(link.front().start, before.front().start), 1e-12);
    DOUBLES_EQUAL(0.0, distance(link.back().end, {11.0, 11.0}), 1e-12);
    DOUBLES_EQUAL(40.0 + std::sqrt(2.0), way(link), 1e-9);
}

TEST(LinkAlongPass, GoesTheShorterWayRound)
{
    Contour before = square(10.0);
    std::rotate(before.begin(), before.begin() + 3, before.end());
    const std::vector<Edge> link = link_along_pass(before, triangle(), 2.0);
    DOUBLES_EQUAL(20.0 + std::sqrt(2.0), way(link), 1e-9);
    CHECK(distance(link.front().end, {10.0, 10.0}) < 1e-9);
}

TEST(LinkAlongPass, IsNoneWhereNoPlaceIsNear)
{
    CHECK(link_along_pass(square(10.0), triangle(), 1.0).empty());
}

TEST(LinkAlongPass, FollowsPartsOfArcs)
{
    const Contour circle{arc_edge({-10, 0}, {10, 0}, {0, 0}, 1),
                         arc_edge({10, 0}, {-10, 0}, {0, 0}, 1)};
    const std::vector<Edge> link = link_along_pass(circle, {line_edge({0, 11}, {5, 14})}, 2.0);
    DOUBLES_EQUAL(10.0 * 1.5707963267948966 + 1.0, way(link), 1e-9);
}

}  // namespace
}  // namespace cusp::test
