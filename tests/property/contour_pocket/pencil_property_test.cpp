// Patches over level floors: stock left at the foot of their cliffs, by brute force.
#include <cstdio>

#include "tests/judges/pocket_judge.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace job;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kLow = -8.0;
constexpr double kFarFromCliff = 0.03;  // mm: nearer the tolerances may leave a skin
constexpr double kPitch = 0.03;         // mm between tips

// A turned rectangle, or a circle, over the floor.
struct Patch {
    Vec2d centre;
    Vec2d along;  // unit vector
    double length, width;
    double radius;  // of a circle; 0: a rectangle
    double top;

    Vec2d inward(Vec2d p) const
    {
        const Vec2d arm = p - centre;
        return {dot(arm, along), dot(arm, left_normal(along))};
    }

    // From the patch, 0 inside.
    double distance(Vec2d p) const
    {
        const Vec2d q = inward(p);
        if (radius > 0.0) {
            return std::max(0.0, std::sqrt(dot(q, q)) - radius);
        }
        const double x = std::max(0.0, std::abs(q.x) - 0.5 * length);
        const double y = std::max(0.0, std::abs(q.y) - 0.5 * width);
        return std::hypot(x, y);
    }

    // Share of the way round, `out` mm from the edge.
    Vec2d around(double share, double out) const
    {
        const double angle = 6.283185307179586 * share;
        const Vec2d ray{std::cos(angle), std::sin(angle)};
        const Vec2d way = along * ray.x + left_normal(along) * ray.y;
        double low = 0.0;
        double high = length + width + 2.0 * radius + out;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            (distance(centre + way * middle) > out ? high : low) = middle;
        }
        return centre + way * high;
    }
};

// In the parameters, which run from 0 to 1 over twice the radius and some more.
Curve trim_circle(double radius)
{
    const double w = std::sqrt(0.5);
    Curve circle{2, {0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0}, {}, {}};
    const double corners[][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                 {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (int i = 0; i < 9; ++i) {
        circle.points.push_back({0.5 + radius * corners[i][0], 0.5 + radius * corners[i][1], 0.0});
        circle.weights.push_back(i % 2 == 0 ? 1.0 : w);
    }
    return circle;
}

Surface surface_of(const Patch& patch)
{
    if (patch.radius == 0.0) {
        return turned_plate(patch.centre, patch.along, patch.length, patch.width, patch.top);
    }
    const double side = 3.0 * patch.radius;
    Surface s = turned_plate(patch.centre, patch.along, side, side, patch.top);
    s.trims = {{trim_circle(1.0 / 3.0)}};
    return s;
}

// The lowest tip at such a distance from the patch, above which another one may lie on
// a ledge.
struct Ledge {
    double width, top;
};

double tip_at(const Tool& tool, const Patch& patch, double apart, const Ledge& ledge)
{
    const auto over = [&](double top, double away) {
        return away < tool.radius ? std::max(kLow, top - profile_height(tool, away)) : kLow;
    };
    return std::max(over(patch.top, std::max(0.0, apart)),
                    over(ledge.top, std::max(0.0, apart + ledge.width)));
}

// The lowest cut of the tool at such a distance from the patch, over tips along the normal of its edge.
double best_at(const Tool& tool, const Patch& patch, double apart, const Ledge& ledge = {0.0, kLow})
{
    if (apart == 0.0) {
        return patch.top;
    }
    constexpr int kPlaces = 4000;
    double best = 1e300;
    for (int i = 0; i < kPlaces; ++i) {
        const double out = 0.999999 * tool.radius * (2.0 * i / kPlaces - 1.0);
        const double tip = tip_at(tool, patch, apart + out, ledge);
        best = std::min(best, tip + profile_height(tool, std::abs(out)));
    }
    return best;
}

// Cosine of the slope of the stock that the tool leaves at best.
double cosine_at(const Tool& tool,
                 const Patch& patch,
                 double apart,
                 const Ledge& ledge = {0.0, kLow})
{
    constexpr double kStep = 0.005;
    const double rise =
        best_at(tool, patch, apart + kStep, ledge) - best_at(tool, patch, apart - kStep, ledge);
    return 1.0 / std::hypot(1.0, rise / (2.0 * kStep));
}

Loop square_loop(double half)
{
    return loop_of({{-half, -half}, {half, -half}, {half, half}, {-half, half}});
}

// Rotated at random; every second one is a circle.
Patch random_patch(Random& random, int i, double least, double most)
{
    const double angle = uniform(random, 0.0, 3.0);
    const double round = i % 2 == 0 ? 0.0 : uniform(random, 3.0, 6.0);
    return {{uniform(random, -4.0, 4.0), uniform(random, -4.0, 4.0)},
            {std::cos(angle), std::sin(angle)},
            round > 0.0 ? 0.0 : uniform(random, 5.0, 14.0),
            round > 0.0 ? 0.0 : uniform(random, 4.0, 10.0),
            round,
            kLow + uniform(random, least, most)};
}

struct Found {
    double left;   // mm, over the best that the tool reaches, square to it
    double gouge;  // mm
    double gouge_bound;
};

Found at_foot(const Operation& operation, const Patch& patch)
{
    const double radius = operation.tool.radius;
    const PlannedOperation planned = planned_pocket(operation);
    const std::vector<Vec3d> tips = tips_of(planned.path, 0.0, kPitch);
    Found found{0.0, 0.0, planned.stats.gouge_bound_mm};
    for (const double out : {0.0, kFarFromCliff, 0.1, 0.2 * radius, 0.5 * radius, radius}) {
        for (double share = 0.0; share < 1.0; share += 0.01) {
            const Vec2d p = patch.around(share, out);
            const double apart = patch.distance(p);
            const double cut = lowest_cut(operation.tool, tips, p);
            const double part = apart > 1e-9 ? kLow : patch.top;
            found.gouge = std::max(found.gouge, part - cut);
            if (out > 0.0) {
                const double left = cut - best_at(operation.tool, patch, apart);
                found.left = std::max(found.left, left * cosine_at(operation.tool, patch, apart));
            }
        }
    }
    return found;
}

TEST_GROUP(RandomCliff){};

TEST(RandomCliff, LeavesNoMoreAtItsFootThanTheScallop)
{
    constexpr unsigned kSeed = 2026;
    Random random{kSeed};
    for (int i = 0; i < property_cases(3); ++i) {
        const double radius = uniform(random, 1.5, 3.0);
        const Patch patch = random_patch(random, i, 0.2, 5.0);
        const ToolShape shapes[] = {ToolShape::kFlat, ToolShape::kBall, ToolShape::kBull};
        const Operation operation = random_pocket(
            random, {turned_plate({0.0, 0.0}, {1.0, 0.0}, 60.0, 60.0, kLow), surface_of(patch)},
            square_loop(20.0), {1, shapes[i % 3], radius, 0.0}, 0.2);
        const Found found = at_foot(operation, patch);
        std::printf("seed %u cliff %d: height %.2f, tool %.2f/%.2f, left %.4f of %.4f\n", kSeed, i,
                    patch.top - kLow, radius, operation.tool.corner_radius, found.left,
                    *operation.tolerance.scallop);
        CHECK(found.gouge <= 1e-6);
        CHECK(found.left <= *operation.tolerance.scallop + 2e-3);
        DOUBLES_EQUAL(0.0, found.gouge_bound, 1e-9);
    }
}

// If the tool's side is nearly vertical at the cliff's edge, its height changes almost in a jump.
TEST(RandomCliff, LeavesNoMoreAtTheFootOfACliffAsHighAsTheToolIsRound)
{
    constexpr unsigned kSeed = 907;
    Random random{kSeed};
    for (int i = 0; i < property_cases(2); ++i) {
        const double radius = uniform(random, 1.2, 2.5);
        Operation operation =
            random_pocket(random, {}, square_loop(20.0), {1, ToolShape::kBull, radius, 0.0}, 0.05);
        operation.tool.corner_radius = uniform(random, 0.5, 0.7) * radius;
        Patch patch = random_patch(random, i, 0.2, 1.0);
        patch.top = kLow + uniform(random, 0.99, 1.0) * operation.tool.corner_radius;
        operation.part.floor = {turned_plate({0.0, 0.0}, {1.0, 0.0}, 60.0, 60.0, kLow),
                                surface_of(patch)};
        const Found found = at_foot(operation, patch);
        std::printf("seed %u round %d: height %.4f, tool %.2f/%.4f, left %.4f of %.4f\n", kSeed, i,
                    patch.top - kLow, radius, operation.tool.corner_radius, found.left,
                    *operation.tolerance.scallop);
        CHECK(found.gouge <= 1e-6);
        CHECK(found.left <= *operation.tolerance.scallop + 2e-3);
    }
}

// The stock left at the foot of the lower cliff does not depend on the height of the upper one.
TEST(RandomCliff, LeavesNoMoreAtTheFootOfALedgeThanTheScallop)
{
    constexpr unsigned kSeed = 35;
    Random random{kSeed};
    const ToolShape shapes[] = {ToolShape::kBull, ToolShape::kFlat, ToolShape::kBall};
    for (int i = 0; i < property_cases(3); ++i) {
        const double radius = uniform(random, 1.5, 3.0);
        Patch patch = random_patch(random, 0, 2.0, 3.0);
        patch.length = uniform(random, 12.0, 14.0);
        const Ledge ledge{uniform(random, 0.045, 0.08) * radius, patch.top + 3.0};
        Operation operation = random_pocket(
            random,
            {turned_plate({0.0, 0.0}, {1.0, 0.0}, 60.0, 60.0, kLow), surface_of(patch),
             turned_plate(patch.centre, patch.along, patch.length, patch.width - 2.0 * ledge.width,
                          ledge.top)},
            square_loop(20.0), {1, shapes[i % 3], radius, 0.0}, 0.1);
        if (operation.tool.shape == ToolShape::kBull) {
            operation.tool.corner_radius = std::min(operation.tool.corner_radius, 0.4 * radius);
        }
        const std::vector<Vec3d> tips = tips_of(planned_pocket(operation).path, 0.0, kPitch);
        const Vec2d across = left_normal(patch.along);
        double most = 0.0;
        for (double out = kFarFromCliff; out < radius; out += 0.1) {
            for (double along = -0.25; along < 0.25; along += 0.02) {
                const Vec2d p = patch.centre + patch.along * (along * patch.length) +
                                across * (0.5 * patch.width + out);
                const double left = lowest_cut(operation.tool, tips, p) -
                                    best_at(operation.tool, patch, out, ledge);
                most = std::max(most, left * cosine_at(operation.tool, patch, out, ledge));
            }
        }
        std::printf("seed %u ledge %d: width %.3f, tool %.2f/%.2f, left %.4f of %.4f\n", kSeed, i,
                    ledge.width, radius, operation.tool.corner_radius, most,
                    *operation.tolerance.scallop);
        CHECK(most <= *operation.tolerance.scallop + 2e-3);
    }
}

// The tool hardly fits between the line where it drops off the cliff and the wall.
TEST(RandomCliff, LeavesNoMoreAtItsFootBesideAWallThanTheScallop)
{
    constexpr unsigned kSeed = 76;
    constexpr double kHalf = 10.0;
    Random random{kSeed};
    const ToolShape shapes[] = {ToolShape::kBall, ToolShape::kFlat, ToolShape::kBull};
    for (int i = 0; i < property_cases(3); ++i) {
        const double radius = uniform(random, 1.5, 2.5);
        // The tool's axis is at most the tolerance off its distance from the wall.
        const double room = uniform(random, 0.02, 0.1) * radius + 0.02;
        const double edge = -kHalf + 2.0 * radius + room;
        const double top = kLow + uniform(random, 1.05, 1.5) * radius;
        // Rotated, so that some loops cross the line.
        const double angle = uniform(random, 0.0, 0.004);
        const Patch patch{
            {edge + 15.0, 0.0}, {std::cos(angle), std::sin(angle)}, 30.0, 30.0, 0.0, top};
        Operation operation = random_pocket(
            random, {turned_plate({0.0, 0.0}, {1.0, 0.0}, 80.0, 80.0, kLow), surface_of(patch)},
            square_loop(kHalf), {1, shapes[i % 3], radius, 0.0}, 0.1);
        const std::vector<Vec3d> tips = tips_of(planned_pocket(operation).path, 0.0, kPitch);
        double most = 0.0;
        for (double out = kFarFromCliff; out < 0.5 * radius; out += 0.1) {
            for (double y = -kHalf + 1.5 * radius; y < kHalf - 1.5 * radius; y += 0.1) {
                const Vec2d p{edge - out, y};
                const double apart = patch.distance(p);
                if (apart > kFarFromCliff) {
                    const double left =
                        lowest_cut(operation.tool, tips, p) - best_at(operation.tool, patch, apart);
                    most = std::max(most, left * cosine_at(operation.tool, patch, apart));
                }
            }
        }
        std::printf("seed %u wall %d: room %.3f, tool %.2f/%.2f, left %.4f of %.4f\n", kSeed, i,
                    room, radius, operation.tool.corner_radius, most, *operation.tolerance.scallop);
        CHECK(most <= *operation.tolerance.scallop + 2e-3);
    }
}

// From the side, a ball that cuts a tolerance into the edge would remove more of the patch.
TEST(RandomCliff, IsCutNoDeeperThanATwoSidedTolerance)
{
    constexpr unsigned kSeed = 718;
    Random random{kSeed};
    for (int i = 0; i < property_cases(4); ++i) {
        const double radius = uniform(random, 1.0, 3.0);
        const Patch patch = random_patch(random, i, 0.2, 1.0);
        Operation operation = random_pocket(
            random, {turned_plate({0.0, 0.0}, {1.0, 0.0}, 60.0, 60.0, kLow), surface_of(patch)},
            square_loop(20.0), {1, ToolShape::kBall, radius, 0.0}, 0.2);
        operation.tolerance.side = ToleranceSide::kBoth;
        operation.output = i % 3 == 0 ? OutputForm::kLines : OutputForm::kArcs;
        const PlannedOperation planned = planned_pocket(operation);
        const std::vector<Vec3d> tips = tips_of(planned.path, 0.0, kPitch);
        double deepest = 0.0;
        for (double share = 0.0; share < 1.0; share += 0.0025) {
            const Vec2d p = patch.around(share, 0.0);
            deepest = std::max(deepest, patch.top - lowest_cut(operation.tool, tips, p));
        }
        std::printf("seed %u cliff %d: height %.2f, ball %.2f, cut %.5f of %.4f bound %.5f\n",
                    kSeed, i, patch.top - kLow, radius, deepest, operation.tolerance.floor,
                    planned.stats.gouge_bound_mm);
        CHECK(deepest <= operation.tolerance.floor + 1e-6);
        CHECK(deepest <= planned.stats.gouge_bound_mm + 1e-6);
    }
}

}  // namespace
}  // namespace cusp::test
