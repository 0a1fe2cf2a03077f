// Random pockets with islands on random floors: no gouge, nothing left above the scallop.
#include <cstdio>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/geometry/offset/region_check.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/judges/pocket_judge.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace job;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

Curve line_curve(Vec2d a, Vec2d b)
{
    return {1, {0.0, 0.0, 1.0, 1.0}, {{a.x, a.y, 0.0}, {b.x, b.y, 0.0}}, {1.0, 1.0}};
}

Curve bent_curve(Random& random, Vec2d a, Vec2d b)
{
    const Vec2d chord = b - a;
    const Vec2d aside = left_normal(chord) * -1.0;
    const Vec2d p = a + chord * 0.33 + aside * uniform(random, -0.1, 0.2);
    const Vec2d q = a + chord * 0.66 + aside * uniform(random, -0.1, 0.2);
    return {3,
            {0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0},
            {{a.x, a.y, 0.0}, {p.x, p.y, 0.0}, {q.x, q.y, 0.0}, {b.x, b.y, 0.0}},
            {1.0, 1.0, 1.0, 1.0}};
}

Loop random_loop(Random& random, Vec2d centre, double radius, int corners)
{
    const Contour star = random_star(random, centre, radius, corners, 0.0);
    Loop loop;
    for (const Edge& edge : star) {
        const bool straight = uniform(random, 0.0, 1.0) < 0.5;
        loop.push_back(straight ? line_curve(edge.start, edge.end)
                                : bent_curve(random, edge.start, edge.end));
    }
    return loop;
}

Region2d region_of(const Operation& operation)
{
    Region2d region;
    const auto add = [&](const Loop& loop, bool outer) {
        Contour contour;
        for (const Curve& curve : loop) {
            const int n = curve.degree == 1 ? 1 : 200;
            for (int i = 0; i < n; ++i) {
                const Vec3d a = point_at(curve, static_cast<double>(i) / n);
                const Vec3d b = point_at(curve, static_cast<double>(i + 1) / n);
                contour.push_back(line_edge({a.x, a.y}, {b.x, b.y}));
            }
        }
        region.contours.push_back((area(contour) > 0.0) == outer ? contour : reversed(contour));
    };
    add(*operation.outline.boundary, true);
    for (const Loop& island : operation.outline.islands) {
        add(island, false);
    }
    return region;
}

Operation random_operation(Random& random)
{
    while (true) {
        Operation operation;
        operation.strategy = &cusp::contour_pocket::kContourPocket;
        operation.part.floor = {
            random_floor(random, {0.0, 0.0, 100.0, 100.0}, -12.0, uniform(random, 1.0, 6.0))};
        operation.part.floor_files = {"floor"};
        operation.outline.boundary = random_loop(random, {50.0, 50.0}, 44.0, 6);
        operation.outline.boundary_file = "boundary";
        if (uniform(random, 0.0, 1.0) < 0.7) {
            operation.outline.islands.push_back(random_loop(random, {48.0, 53.0}, 9.0, 5));
            operation.outline.island_files.emplace_back("island");
        }
        const double radius = uniform(random, 3.0, 5.0);
        operation.tool = {1, ToolShape::kBall, radius, radius};
        operation.tolerance.plan = operation.tolerance.floor = 0.02;
        operation.tolerance.scallop = 0.3;
        operation.output = uniform(random, 0.0, 1.0) < 0.5 ? OutputForm::kLines : OutputForm::kArcs;
        if (!find_fault(region_of(operation))) {
            return operation;
        }
    }
}

TEST_GROUP(RandomPocket){};

TEST(RandomPocket, HasNoGougeAndNothingLeftOverTheScallop)
{
    constexpr unsigned kSeed = 1990;
    Random random{kSeed};
    for (int i = 0; i < property_cases(3); ++i) {
        const Operation operation = random_operation(random);
        Job job;
        job.file = "job";
        job.stock_top = 2.0;
        job.clearance = 5.0;
        const std::vector<PlannedOperation> planned = plan_contour_pocket(job, operation);
        const PocketVerdict verdict = judge_pocket(operation.part.floor, region_of(operation),
                                                   planned.back().path, job.stock_top, 180);
        std::printf("seed %u pocket %d: floor gouge %.4f wall gouge %.4f left %.4f uncut %.4f\n",
                    kSeed, i, verdict.floor_gouge, verdict.wall_gouge, verdict.most_left,
                    verdict.uncut);
        CHECK(verdict.floor_gouge <= 1e-6);
        CHECK(verdict.wall_gouge <= 1e-3);
        CHECK(verdict.most_left <= 0.3 + 1e-3);
        DOUBLES_EQUAL(0.0, verdict.uncut, 0.0);
        DOUBLES_EQUAL(0.0, planned.back().stats.gouge_bound_mm, 1e-9);
    }
}

}  // namespace
}  // namespace cusp::test
