// Every end of a tool over random triangles, against dense samples of the triangles and the profile of
// the tool alone.
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

constexpr int kSideParts = 50;     // samples of a side
constexpr double kSpacing = 0.25;  // mm: of samples, at most
constexpr double kRounded = 0.01;  // mm: what a core adds where a cone ends

Tool taper(double radius, double corner, double flat, double half_angle)
{
    Tool out{1, ToolShape::kTaper, radius, corner};
    out.tip_angle = 2 * half_angle;
    out.tip_radius = flat;
    return out;
}

const std::vector<Tool> kEnds{
    kBall, kFlat, kBull, taper(3, 0.5, 0, 0.2), taper(3, 0, 0.6, 0.3), taper(2, 0, 0, 0.7)};

template <class Visit>
void visit_samples(const std::vector<Triangle>& triangles, const Visit& visit)
{
    for (const Triangle& t : triangles) {
        for (int i = 0; i <= kSideParts; ++i) {
            for (int j = 0; i + j <= kSideParts; ++j) {
                visit(t[0] + (t[1] - t[0]) * (1.0 * i / kSideParts) +
                      (t[2] - t[0]) * (1.0 * j / kSideParts));
            }
        }
    }
}

// The highest tip at which a sample is touched; too low by what lies between samples.
double sampled_drop(const std::vector<Triangle>& triangles, const Tool& tool, double x, double y)
{
    double highest = -1e9;
    visit_samples(triangles, [&](Vec3d p) {
        const double lower = profile_height(tool, std::hypot(p.x - x, p.y - y));
        if (std::isfinite(lower)) {
            highest = std::max(highest, p.z - lower);
        }
    });
    return highest;
}

// How far the tool has to rise until no sample is in it.
double sampled_depth(const std::vector<Triangle>& triangles, const Tool& tool, Vec3d tip)
{
    return sampled_drop(triangles, tool, tip.x, tip.y) - tip.z;
}

}  // namespace

TEST_GROUP(EveryEnd){};

TEST(EveryEnd, RestsOnTheHighestSample)
{
    std::mt19937 random{3};
    std::uniform_real_distribution<double> place{0, 20};
    const std::vector<Triangle> triangles = random_triangles(random, 14);
    const PartModel model{triangles};
    for (const Tool& tool : kEnds) {
        double most = 0;
        for (int k = 0; k < 60; ++k) {
            const double x = place(random);
            const double y = place(random);
            const auto rest = model.drop_tool(tool, x, y);
            const double sampled = sampled_drop(triangles, tool, x, y);
            if (!rest) {
                CHECK(sampled < -1e8);
                continue;
            }
            CHECK(rest->tip.z >= sampled - 1e-9);
            // It touches the place that it names.
            const double lower =
                profile_height(tool, std::hypot(rest->point.x - x, rest->point.y - y) - 1e-9);
            CHECK(rest->tip.z + lower - rest->point.z < kRounded ||
                  std::hypot(rest->point.x - x, rest->point.y - y) > tool.radius - kRounded);
            most = std::max(most, std::min(1.0, rest->tip.z - sampled));
            DOUBLES_EQUAL(0, model.distance(tool, rest->tip, 1).distance, 1e-6);
        }
        CHECK(most < 1);
    }
}

TEST(EveryEnd, IsClearExactlyWhereNoSampleIsInIt)
{
    std::mt19937 random{5};
    std::uniform_real_distribution<double> place{0, 20};
    const std::vector<Triangle> triangles = random_triangles(random, 14);
    const PartModel model{triangles};
    for (const Tool& tool : kEnds) {
        int clear = 0;
        for (int k = 0; k < 60; ++k) {
            const Vec3d tip{place(random), place(random), 0.4 * place(random)};
            const double distance = model.distance(tool, tip, 100).distance;
            const double depth = sampled_depth(triangles, tool, tip);
            if (distance > 1e-6) {
                ++clear;
                CHECK(depth <= 0);
            }
            // A tool so far above all samples is not called blocked.
            if (depth < -kSpacing * 20) {
                CHECK(distance > 0);
            }
        }
        CHECK(clear > 5);
    }
}

// The bound of a move is no more than the distance at any place of it, and nearly the least of them.
TEST(EveryEnd, BoundsTheClearanceOfAMove)
{
    std::mt19937 random{9};
    std::uniform_real_distribution<double> place{0, 20};
    const std::vector<Triangle> triangles = random_triangles(random, 14);
    const PartModel model{triangles};
    constexpr double kSufficient = 0.5;
    constexpr double kResolution = 1e-4;
    for (const Tool& tool : kEnds) {
        int near = 0;
        for (int k = 0; k < 60; ++k) {
            const Vec3d a{place(random), place(random), 3 + 0.3 * place(random)};
            const Vec3d b{place(random), place(random), 3 + 0.3 * place(random)};
            const double bound = model.move_clearance(tool, a, b, kSufficient, kResolution);
            double least = kSufficient;
            for (int part = 0; part <= 2000; ++part) {
                const Vec3d tip = a + (b - a) * (part / 2000.0);
                least = std::min(least, model.distance(tool, tip, kSufficient).distance);
            }
            CHECK(bound <= least + 1e-6);
            CHECK(bound >= least - kResolution - norm(b - a) / 4000);
            near += least < kSufficient ? 1 : 0;
        }
        CHECK(near > 10);
    }
}
