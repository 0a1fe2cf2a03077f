// Sweeps of random tools against the tool at a thousand places of the way.
#include "host_tools/cam/rest_machining/tool_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"

using namespace cusp;
using namespace cusp::rest_machining;
using namespace cusp::toolpath;

namespace {

const std::vector<Tool> kTools{
    {1, ToolShape::kFlat, 3, 0},        {2, ToolShape::kBall, 3, 3},
    {3, ToolShape::kBull, 3, 1},        {4, ToolShape::kVee, 3, 0, kPi / 3, 0.2},
    {5, ToolShape::kDrill, 2, 0, 2.06}, {6, ToolShape::kTaper, 3, 0.5, kPi / 6}};

class RandomPlaces {
public:
    explicit RandomPlaces(unsigned seed) : draw_{seed} {}
    double number(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(draw_);
    }
    Vec2d plan(double reach)
    {
        const double x = number(-reach, reach);
        const double y = number(-reach, reach);
        return {x, y};
    }
    Vec3d tip()
    {
        const Vec2d p = plan(4);
        const double z = number(-2, 0);
        return {p.x, p.y, z};
    }

private:
    std::mt19937 draw_;
};

// The least over places of the way, none of them between two of which it changes by much.
double sampled_height(const Tool& tool, Vec3d from, Vec3d to, Vec2d p)
{
    constexpr int kPlaces = 4000;
    double z = kInfinite;
    for (int i = 0; i <= kPlaces; ++i) {
        const Vec3d tip = from + (static_cast<double>(i) / kPlaces) * (to - from);
        z = std::min(z, tip.z + profile_height(tool, norm(p - in_plan(tip))));
    }
    return z;
}

}  // namespace

TEST_GROUP(ToolSweep){};

TEST(ToolSweep, its_lower_side_is_the_lowest_of_the_tool_on_the_way)
{
    RandomPlaces random{7};
    for (const Tool& tool : kTools) {
        for (int i = 0; i < 40; ++i) {
            const Vec3d from = random.tip();
            Vec3d to = random.tip();
            to.z = i % 3 == 0 ? from.z : to.z;
            const Vec2d p = random.plan(6);
            const double sampled = sampled_height(tool, from, to, p);
            const double height = ToolSweep{EndProfile{tool}, from, to}.height(p);
            // beside a rim the places miss what the sweep has
            CHECK(height <= sampled + 1e-9);
            if (sampled < kInfinite && tool.shape != ToolShape::kFlat) {
                CHECK(height >= sampled - 0.1);
            }
        }
    }
}

TEST(ToolSweep, is_nowhere_below_its_planes_and_touches_them)
{
    RandomPlaces random{11};
    for (const Tool& tool : kTools) {
        for (int i = 0; i < 200; ++i) {
            const Vec3d from = random.tip();
            Vec3d to = random.tip();
            to.z = i % 3 == 0 ? from.z : to.z;
            const ToolSweep sweep{EndProfile{tool, 0.02}, from, to};
            const SupportPlane plane = sweep.plane_below(random.plan(6));
            DOUBLES_EQUAL(sweep.height(plane.place), plane.z, 1e-6);
            for (int k = 0; k < 50; ++k) {
                const Vec2d p = random.plan(7);
                CHECK(sweep.height(p) >= plane.at(p) - 1e-6);
            }
        }
    }
}

TEST(ToolSweep, contains_only_what_is_inside_it)
{
    RandomPlaces random{13};
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const Tool& outer = kTools[static_cast<std::size_t>(i) % 3];
        const Tool& inner = kTools[static_cast<std::size_t>(i / 3) % 3];
        const Vec3d from = random.tip();
        const Vec3d to = random.tip();
        const ToolSweep large{EndProfile{outer}, from, to};
        const double shrink = random.number(0.5, 2.5);
        const Vec3d up{0, 0, random.number(0, 1)};
        const ToolSweep small{EndProfile{inner, shrink}, from + up, from + 0.5 * (to - from) + up};
        if (!large.contains(small)) {
            continue;
        }
        ++found;
        for (int k = 0; k < 20; ++k) {
            const Vec2d p = random.plan(6);
            CHECK(large.height(p) <= small.height(p) + 1e-9);
        }
    }
    CHECK(found > 300);
}

TEST(ToolSweep, of_a_shrunk_tool_is_that_deep_inside)
{
    // a ball less 0.5 has the same centre; a cone's flank moves square to itself
    const ToolSweep ball{EndProfile{kTools[1], 0.5}, {0, 0, 0}, {0, 0, 0}};
    DOUBLES_EQUAL(0.5, ball.height({0, 0}), 1e-12);
    DOUBLES_EQUAL(3.0, ball.height({2.5, 0}), 1e-9);
    CHECK(ball.height({2.51, 0}) == kInfinite);
    const Tool vee{4, ToolShape::kVee, 3, 0, kPi / 3, 0};
    const ToolSweep cone{EndProfile{vee, 0.1}, {0, 0, 0}, {0, 0, 0}};
    DOUBLES_EQUAL(0.2, cone.height({0, 0}), 1e-9);
}
