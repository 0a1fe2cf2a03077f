// The medial axis and carving with a vee on random outlines, judged by distances from their edges by
// brute force: the disc about an inner point reaches to the nearest edge, a carved point lies as deep
// as the flank that begins there.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/medial_axis.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/draw.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/test_jobs.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace prismatic;
using job::Job;
using job::Operation;
using offset::contains;
using offset::Contour;
using offset::distance_to;
using offset::line_edge;
using offset::Region2d;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolMove;
using toolpath::ToolShape;

namespace {

using Corners = std::vector<Vec2d>;

Corners star(Draw& draw, Vec2d centre, double least, double most)
{
    Corners corners;
    const int n = draw.whole(3, 11);
    const double turn = draw.uniform(0, 2 * kPi);
    for (int i = 0; i < n; ++i) {
        const double angle = turn + 2 * kPi * (i + draw.uniform(-0.3, 0.3)) / n;
        const double r = draw.uniform(least, most);
        corners.push_back(centre + Vec2d{r * std::cos(angle), r * std::sin(angle)});
    }
    return corners;
}

// A rectangle, where whole stretches of the axis have one radius; turned or not.
Corners rectangle(Draw& draw)
{
    const double turn = draw.whole(0, 1) * draw.uniform(0, kPi);
    const Vec2d x{std::cos(turn), std::sin(turn)};
    const Vec2d y{-x.y, x.x};
    const double a = draw.uniform(2, 20);
    const double b = draw.whole(0, 2) == 0 ? a : draw.uniform(2, 20);
    return {x * -a - y * b, x * a - y * b, x * a + y * b, y * b - x * a};
}

// An outline, with a hole in two of three.
std::vector<Corners> random_outlines(Draw& draw)
{
    if (draw.whole(0, 4) == 0) {
        return {rectangle(draw)};
    }
    std::vector<Corners> outlines{star(draw, {0, 0}, 8, 20)};
    if (draw.whole(0, 2) > 0) {
        const Corners hole = star(draw, {0, 0}, 0.5, 2.0);
        outlines.push_back(hole);
    }
    return outlines;
}

Region2d region_of(const std::vector<Corners>& outlines)
{
    Region2d region;
    for (const Corners& corners : outlines) {
        Contour contour;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            contour.push_back(line_edge(corners[i], corners[(i + 1) % corners.size()]));
        }
        region.contours.push_back(region.contours.empty() ? contour : offset::reversed(contour));
    }
    return region;
}

// True if the outlines keep off each other and themselves: stars do, but for a hole too near.
bool is_plain(const Region2d& region)
{
    if (region.contours.size() < 2) {
        return true;
    }
    const Region2d outer{{region.contours.front()}};
    for (const offset::Edge& edge : region.contours.back()) {
        for (int i = 0; i < 20; ++i) {
            const Vec2d p = point_on(edge, i / 20.0);
            if (!contains(outer, p) || distance_to(outer, p) < 0.3) {
                return false;
            }
        }
    }
    return true;
}

// The least of a convex function on [0, 1].
template <class Function>
double least_of(const Function& f)
{
    double a = 0;
    double b = 1;
    for (int i = 0; i < 30; ++i) {
        const double c = a + (b - a) / 3;
        const double d = b - (b - a) / 3;
        (f(c) < f(d) ? b : a) = f(c) < f(d) ? d : c;
    }
    return std::min({f(0.0), f(1.0), f((a + b) / 2)});
}

// The greatest distance from q to the rim of a disc about the axis that q lies in.
double covered(const std::vector<AxisBranch>& axis, Vec2d q)
{
    double best = -kUnbounded;
    for (const AxisBranch& branch : axis) {
        best = std::max(best, branch.front().radius - norm(branch.front().at - q));
        for (std::size_t i = 1; i < branch.size(); ++i) {
            const AxisPoint& a = branch[i - 1];
            const AxisPoint& b = branch[i];
            const double reach = std::max(a.radius, b.radius) + norm(a.at - b.at);
            if (norm(a.at - q) > reach) {
                continue;
            }
            best = std::max(best, -least_of([&](double t) {
                                return norm(a.at + (b.at - a.at) * t - q) - a.radius -
                                       (b.radius - a.radius) * t;
                            }));
        }
    }
    return best;
}

Vec2d random_point(Draw& draw) { return {draw.uniform(-22, 22), draw.uniform(-22, 22)}; }

void check_axis(Draw& draw, const Region2d& region)
{
    const std::vector<AxisBranch> axis = medial_axis(region);
    for (const AxisBranch& branch : axis) {
        for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
            const double t = draw.uniform(0, 1);
            const Vec2d p = branch[i].at + (branch[i + 1].at - branch[i].at) * t;
            const double radius = branch[i].radius + (branch[i + 1].radius - branch[i].radius) * t;
            CHECK(radius <= distance_to(region, p) + 2e-5);
            CHECK(radius < 1e-3 || contains(region, p));
        }
    }
    for (int i = 0; i < 60; ++i) {
        const Vec2d q = random_point(draw);
        if (contains(region, q)) {
            CHECK(covered(axis, q) >= distance_to(region, q) - 3 * kAxisTolerance);
        }
    }
}

Operation carving_of(Draw& draw, const std::vector<Corners>& outlines)
{
    Operation operation;
    operation.strategy = &cusp::prismatic::kVCarve;
    operation.tool = {1,   ToolShape::kVee,        draw.uniform(2, 25),
                      0.0, draw.uniform(0.4, 2.2), draw.whole(0, 1) * 0.1};
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.scallop = draw.uniform(0.1, 0.5);
    operation.prismatic.emplace();
    for (const Corners& corners : outlines) {
        const bool hole = !operation.prismatic->loops.empty();
        operation.prismatic->loops.push_back({loop_of(corners), "outline", hole});
    }
    const double flank = (operation.tool.radius - operation.tool.tip_radius) /
                         std::tan(operation.tool.tip_angle / 2);
    operation.prismatic->given_depth = draw.whole(0, 1) == 0;
    operation.prismatic->depth =
        operation.prismatic->given_depth ? draw.uniform(0.1, 1) * flank : flank;
    if (draw.whole(0, 2) == 0) {
        operation.levels.max_depth = draw.uniform(0.3, 1) * operation.prismatic->depth;
    }
    return operation;
}

// z over q of the lower side of the moving tool.
double lowest_over(const PlannedOperation& planned, Vec2d q)
{
    const toolpath::Tool& tool = planned.path.tool;
    const double slope = 1 / std::tan(tool.tip_angle / 2);
    double lowest = 0;
    Vec3d at{0, 0, 100};
    for (const ToolMove& move : planned.path.moves) {
        const Vec3d end = end_of(move);
        const double nearest = norm(in_plan(at) - q) - norm(in_plan(end - at));
        if (move.kind != MoveKind::kRapid &&
            std::min(at.z, end.z) + slope * (nearest - tool.tip_radius) < lowest) {
            lowest = std::min(
                lowest, least_of([&](double t) {
                    const Vec3d p = at + (end - at) * t;
                    return p.z + slope * std::max(0.0, norm(in_plan(p) - q) - tool.tip_radius);
                }));
        }
        at = end;
    }
    return lowest;
}

void check_carving(Draw& draw, const std::vector<Corners>& outlines)
{
    const Region2d region = region_of(outlines);
    const Operation operation = carving_of(draw, outlines);
    const double slope = 1 / std::tan(operation.tool.tip_angle / 2);
    const PlannedOperation planned = plan_v_carve(plain_job(), operation).front();
    const double depth = operation.prismatic->depth;
    // chords of the loops around corners stray by half of the tolerance, away from the wall
    const double exact = 3 * kAxisTolerance * slope + operation.tolerance.floor / 2;
    for (int i = 0; i < 40; ++i) {
        const Vec2d q = random_point(draw);
        const double away = distance_to(region, q);
        const double wanted = contains(region, q) ? -std::min(away * slope, depth) : 0.0;
        const double lowest = lowest_over(planned, q);
        CHECK(lowest >= wanted - 1e-4 * slope - 1e-6);
        const bool on_floor = away * slope >= depth - exact;
        const double left = exact + operation.tool.tip_radius * slope +
                            (on_floor ? *operation.tolerance.scallop : 0.0);
        CHECK(wanted == 0 || lowest <= wanted + left);
    }
}

TEST_GROUP(VCarveProperty){};

TEST(VCarveProperty, DiscsOfTheMedialAxisCoverTheRegionAndNothingElse)
{
    constexpr unsigned kSeed = 61;
    const int cases = property_cases(300);
    std::printf("medial axes: seed %u, %d cases\n", kSeed, cases);
    Draw draw{std::mt19937{kSeed}};
    for (int i = 0; i < cases; ++i) {
        const Region2d region = region_of(random_outlines(draw));
        if (is_plain(region)) {
            // every other one with round corners
            check_axis(draw, i % 2 == 0 ? region : grown(region, draw.uniform(0.02, 0.14)));
        }
    }
}

TEST(VCarveProperty, EveryPointIsAsDeepAsItsDistanceFromTheOutlineSays)
{
    constexpr unsigned kSeed = 62;
    const int cases = property_cases(250);
    std::printf("carvings: seed %u, %d cases\n", kSeed, cases);
    Draw draw{std::mt19937{kSeed}};
    for (int i = 0; i < cases; ++i) {
        const std::vector<Corners> outlines = random_outlines(draw);
        if (is_plain(region_of(outlines))) {
            check_carving(draw, outlines);
        }
    }
}

// In a corner the groove ends exactly at the corner point.
TEST(VCarveProperty, CornersAreSharp)
{
    constexpr unsigned kSeed = 63;
    const int cases = property_cases(200);
    std::printf("corners: seed %u, %d cases\n", kSeed, cases);
    Draw draw{std::mt19937{kSeed}};
    for (int i = 0; i < cases; ++i) {
        const Corners corners = rectangle(draw);
        const std::vector<AxisBranch> axis = medial_axis(region_of({corners}));
        for (const Vec2d corner : corners) {
            double least = kUnbounded;
            for (const AxisBranch& branch : axis) {
                for (const AxisPoint& p : branch) {
                    least = std::min(least, norm(p.at - corner));
                }
            }
            CHECK(least <= 5 * kAxisTolerance);
        }
    }
}

TEST(VCarveProperty, ACircleIsOneDisc)
{
    const Contour circle{
        offset::arc_edge({5, 0}, {-2.5, 5 * std::sqrt(3) / 2}, {0, 0}, 1),
        offset::arc_edge({-2.5, 5 * std::sqrt(3) / 2}, {-2.5, -5 * std::sqrt(3) / 2}, {0, 0}, 1),
        offset::arc_edge({-2.5, -5 * std::sqrt(3) / 2}, {5, 0}, {0, 0}, 1)};
    const std::vector<AxisBranch> axis = medial_axis(Region2d{{circle}});
    LONGS_EQUAL(1, axis.size());
    LONGS_EQUAL(1, axis.front().size());
    DOUBLES_EQUAL(0, norm(axis.front().front().at), 1e-6);
    DOUBLES_EQUAL(5, axis.front().front().radius, 1e-6);
}

}  // namespace
}  // namespace cusp::test
