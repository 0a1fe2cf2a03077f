// Offsets of rounded rectangles, slots and plates with fillets as drawing programs write them: points and
// bulges of a few decimals, so that lines and arcs meet with a kink of 1e-2 to 1e-10 radians.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware/base/math.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/judges/offset_judge.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace offset;

namespace {

using Corners = std::vector<Vec2d>;

double pick(Random& random, std::initializer_list<double> values)
{
    const auto n =
        static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(values.size())));
    return values.begin()[std::min(n, values.size() - 1)];
}

// A number as it is written with so many decimals.
double written(double x, int decimals)
{
    const double unit = std::pow(10.0, decimals);
    return std::round(x * unit) / unit;
}

struct Drawn {
    Corners corners;  // counter-clockwise
    double radius;    // of all corners
};

Drawn rectangle(Random& random)
{
    const double radius =
        pick(random, {0.5, 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, uniform(random, 0.3, 9)});
    const double w = std::round(uniform(random, 2.5 * radius + 1, 120));
    // one in four is a slot
    const double h = uniform(random, 0, 1) < 0.25
                         ? 2 * radius
                         : std::round(uniform(random, 2.5 * radius + 1, 120));
    return {{{0, 0}, {w, 0}, {w, h}, {0, h}}, radius};
}

// An L, a U or a T: fillets turn both ways.
Drawn plate(Random& random)
{
    const double radius = pick(random, {0.5, 1, 1.5, 2, 3, 4, uniform(random, 0.3, 4)});
    const double a = std::round(uniform(random, 4 * radius + 1, 50));
    const double b = std::round(uniform(random, 4 * radius + 1, 50));
    const double c = std::round(uniform(random, 4 * radius + 1, 50));
    const double kind = uniform(random, 0, 3);
    if (kind < 1) {
        return {{{0, 0}, {a + b, 0}, {a + b, c}, {a, c}, {a, c + b}, {0, c + b}}, radius};
    }
    if (kind < 2) {
        return {{{0, 0},
                 {2 * a + b, 0},
                 {2 * a + b, c + b},
                 {a + b, c + b},
                 {a + b, c},
                 {a, c},
                 {a, c + b},
                 {0, c + b}},
                radius};
    }
    return {{{a, 0},
             {a + b, 0},
             {a + b, c},
             {2 * a + b, c},
             {2 * a + b, 2 * c},
             {0, 2 * c},
             {0, c},
             {a, c}},
            radius};
}

Drawn polygon(Random& random)
{
    const int n = static_cast<int>(uniform(random, 3, 9));
    const double size = uniform(random, 15, 60);
    Corners corners;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * kPi * (i + uniform(random, -0.2, 0.2)) / n;
        corners.push_back({size * std::cos(angle), size * std::sin(angle)});
    }
    return {corners, uniform(random, 0.3, 3)};
}

// The corners rounded, each number with so many decimals, through the curves of the import.
Contour filleted(const Drawn& drawn, int decimals)
{
    struct Vertex {
        Vec2d at;
        double bulge;
    };
    std::vector<Vertex> vertices;
    const std::size_t n = drawn.corners.size();
    const auto add = [&](Vec2d p, double bulge) {
        const Vec2d at{written(p.x, decimals), written(p.y, decimals)};
        if (!vertices.empty() && norm(vertices.back().at - at) < 1e-6) {
            vertices.pop_back();
        }
        vertices.push_back({at, written(bulge, decimals)});
    };
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d at = drawn.corners[i];
        const Vec2d in = unit(at - drawn.corners[(i + n - 1) % n]);
        const Vec2d out = unit(drawn.corners[(i + 1) % n] - at);
        const double turn = std::atan2(cross(in, out), dot(in, out));
        const double reach = drawn.radius * std::abs(std::tan(turn / 2));
        add(at - in * reach, std::tan(turn / 4));
        add(at + out * reach, 0.0);
    }
    if (norm(vertices.back().at - vertices.front().at) < 1e-6) {
        vertices.pop_back();
    }
    std::vector<nurbs::Curve> curves;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        curves.push_back(import::bulged_curve(
            vertices[i].at, vertices[(i + 1) % vertices.size()].at, vertices[i].bulge));
    }
    constexpr double kFit = 1e-4;  // mm: as the planners fit loops
    return fit_contour(curves, kFit);
}

Drawn placed(Drawn drawn, Random& random)
{
    const double angle = uniform(random, 0, 1) < 0.6   ? 0.0
                         : uniform(random, 0, 1) < 0.3 ? kPi / 4
                                                       : uniform(random, 0, 2 * kPi);
    const bool whole = uniform(random, 0, 1) < 0.7;
    Vec2d to{uniform(random, -20, 900), uniform(random, -20, 900)};
    to = whole ? Vec2d{std::round(to.x), std::round(to.y)} : to;
    for (Vec2d& p : drawn.corners) {
        p = to + p * std::cos(angle) + left_normal(p) * std::sin(angle);
    }
    return drawn;
}

Contour scaled(Contour contour, double by)
{
    for (Edge& edge : contour) {
        edge = {edge.start * by, edge.end * by, edge.centre * by, edge.radius * by, edge.turn};
    }
    return contour;
}

struct Case {
    Region2d drawn;  // material on the left
    double radius;   // mm: of its fillets
};

Case random_case(Random& random)
{
    const int decimals = static_cast<int>(uniform(random, 2, 10));
    const bool inch = uniform(random, 0, 1) < 0.25;
    const double kind = uniform(random, 0, 3);
    Drawn drawn = placed(kind < 1.6   ? rectangle(random)
                         : kind < 2.3 ? plate(random)
                                      : polygon(random),
                         random);
    if (inch) {
        // whole fractions of an inch, or a drawing in mm written in inch
        const double by = uniform(random, 0, 1) < 0.5 ? 1 / 16.0 : 1 / 25.4;
        for (Vec2d& p : drawn.corners) {
            p = p * by;
        }
        drawn.radius *= by;
    }
    const double to_mm = inch ? 25.4 : 1.0;
    return {{{scaled(filleted(drawn, decimals), to_mm)}}, drawn.radius * to_mm};
}

// A tool's radius: any, one of a drawer, one of the fillet or nearly so, a big one.
double random_distance(Random& random, double radius)
{
    switch (static_cast<int>(uniform(random, 0, 6))) {
        case 0:
            return uniform(random, 0.1, 12);
        case 1:
        case 2:
            return pick(random, {0.5, 1, 1.5, 1.5875, 2, 2.5, 3, 3.175, 4, 5, 6, 6.35, 10});
        // Within 1e-6 mm of the fillet's radius about one loop of 60 is still refused: not among these cases.
        case 3:
        case 4:
            return std::max(
                0.05, radius + pick(random, {1, -1}) * std::pow(10.0, uniform(random, -5, -1)));
        default:
            return uniform(random, 12, 80);
    }
}

// The fault of the offset; empty if there is none.
std::string wrong_of(unsigned seed)
{
    Random random{seed};
    const Case one = random_case(random);
    const double distance = random_distance(random, one.radius);
    const bool outside = uniform(random, 0, 1) < 0.5;
    if (find_fault(one.drawn)) {
        return "";  // rounded to something that crosses itself
    }
    Region2d source = one.drawn;
    if (outside) {
        source.contours[0] = reversed(source.contours[0]);
    }
    const auto says = [&](const std::string& what) {
        char text[200];
        std::snprintf(text, sizeof text, "seed %u, %s %.12g, fillets %.9g: %s", seed,
                      outside ? "outside" : "inside", distance, one.radius, what.c_str());
        return std::string{text};
    };
    const Region2d result = RegionOffset{source}.at(distance);
    const double worst = worst_distance(source, result, distance, outside);
    if (worst > 1e-6) {
        return says("off by " + std::to_string(worst * 1e6) + " nm");
    }
    if (const int wrong = wrong_points(random, source, result, distance, 0.5 * distance, outside)) {
        return says(std::to_string(wrong) + " wrong points");
    }
    const double mine = area(result) * (outside ? -1.0 : 1.0);
    const double clipper = clipper_area(one.drawn, outside ? -distance : distance);
    double border = 1.0;
    for (const Contour& contour : result.contours) {
        border += length(contour);
    }
    if (!(std::abs(clipper - mine) <= 0.02 + 0.005 * border)) {
        return says("area " + std::to_string(mine) + ", Clipper " + std::to_string(clipper));
    }
    return "";
}

TEST_GROUP(TangentJoints){};

TEST(TangentJoints, NoRoundedLoopIsRefusedOrMissed)
{
    const unsigned first = property_seed(4800000);
    const int cases = property_cases(3000);
    std::printf("rounded loops: seeds from %u, %d cases\n", first, cases);
    STRCMP_EQUAL("", broken_cases(first, cases, wrong_of).c_str());
}

}  // namespace
}  // namespace cusp::test
