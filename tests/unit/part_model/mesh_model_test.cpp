// Meshes compared with dense samples of their triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/part_model/part_model.hpp"
#include "tests/generators/random_triangles.hpp"
#include "tests/support/three_tools.hpp"

using namespace cusp;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

using Triangle = std::array<Vec3d, 3>;

// From samples: the least distance from the core, a disc and all above it; too high by their
// spacing.
double sampled_clearance(const std::vector<Triangle>& triangles, const Tool& tool, Vec3d tip)
{
    constexpr int kParts = 60;
    double least = 1e9;
    const Vec3d end = tip + Vec3d{0, 0, tool.corner_radius};
    for (const Triangle& t : triangles) {
        for (int i = 0; i <= kParts; ++i) {
            for (int j = 0; i + j <= kParts; ++j) {
                const Vec3d p =
                    t[0] + (t[1] - t[0]) * (1.0 * i / kParts) + (t[2] - t[0]) * (1.0 * j / kParts);
                const double out = std::max(
                    0.0, std::hypot(p.x - end.x, p.y - end.y) - (tool.radius - tool.corner_radius));
                least = std::min(least, std::hypot(out, std::min(0.0, p.z - end.z)));
            }
        }
    }
    return least - tool.corner_radius;
}

}  // namespace

TEST_GROUP(MeshModel){};

TEST(MeshModel, ClearanceOfEveryToolIsThatOfSamples)
{
    std::mt19937 random{7};
    std::uniform_real_distribution<double> place{-2, 22};
    const std::vector<Triangle> triangles = random_triangles(random, 12);
    const PartModel model{triangles};
    for (int k = 0; k < 60; ++k) {
        const Vec3d tip{place(random), place(random), 0.4 * place(random)};
        for (const Tool& tool : {kBall, kFlat, kBull}) {
            const double sampled = sampled_clearance(triangles, tool, tip);
            const double found = model.distance(tool, tip, 100).distance;
            CHECK(found <= sampled + 1e-6);
            CHECK(found >= sampled - 0.12);
        }
    }
}

TEST(MeshModel, BallRestsOnTheHighestPlaceThatItTouches)
{
    std::mt19937 random{11};
    std::uniform_real_distribution<double> place{0, 20};
    const std::vector<Triangle> triangles = random_triangles(random, 300);
    const PartModel model{triangles};
    int rests = 0;
    for (int k = 0; k < 200; ++k) {
        const double x = place(random);
        const double y = place(random);
        const auto z = model.drop_height(kBall, x, y);
        const auto rest = model.drop_ball(x, y, kBall.radius);
        CHECK_EQUAL(z.has_value(), rest.has_value());
        if (!z) {
            continue;
        }
        ++rests;
        DOUBLES_EQUAL(kBall.radius, norm(rest->centre - rest->point), 1e-9);
        DOUBLES_EQUAL(0, model.distance(kBall, {x, y, *z}, 1).distance, 1e-8);
        // Above that it is clear everywhere.
        for (double up = 0.1; up < 12; up += 0.7) {
            CHECK(model.distance(kBall, {x, y, *z + up}, 1).distance > 0);
        }
    }
    CHECK(rests > 150);
}

TEST(MeshModel, TopIsTheHighestFacetThere)
{
    const PartModel model{{{{{0, 0, 1}, {10, 0, 1}, {0, 10, 1}}},
                           {{{0, 0, 3}, {0, 4, 3}, {4, 0, 3}}},
                           {{{1, 1, 5}, {1, 2, 5}, {1, 1, 9}}}}};
    DOUBLES_EQUAL(3, model.height_at(1.5, 1.5)->point.z, 1e-12);
    DOUBLES_EQUAL(1, model.height_at(4, 4)->point.z, 1e-12);
    CHECK_FALSE(model.height_at(8, 8).has_value());
    DOUBLES_EQUAL(1, model.height_at(4, 4)->normal.z, 1e-12);
}
