// The end of a patch at an angle over a floor, and drops of the tool beside it.
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <malloc.h>
#include <random>

#include "host_tools/geometry/drop_cutter/floor_coverage.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "tests/support/plates.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace drop_cutter;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kRadius = 3.0;
constexpr double kHigh = -8.0;
constexpr double kLow = -10.0;

// About the origin.
Surface level_patch(double along, double across, double angle, double z)
{
    return turned_plate({0.0, 0.0}, {std::cos(angle), std::sin(angle)}, along, across, z);
}

struct Step {
    Tool tool;
    double reach;  // in plan: from the patch to the axis of the dropped tool
};

const Step kSteps[] = {
    {{1, ToolShape::kFlat, kRadius, 0.0}, kRadius},
    {{1, ToolShape::kBull, kRadius, 1.0}, kRadius},
    {{1, ToolShape::kBall, kRadius, kRadius}, std::sqrt(kRadius* kRadius - 1.0)},
};

// Bicubic, 30 mm long, 9 mm high, about the origin.
Surface turned_wall(std::mt19937& random, double angle, double lean)
{
    std::uniform_real_distribution<double> wave{-0.3, 0.3};
    constexpr int kAlong = 6;
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = kAlong;
    s.size_v = 4;
    s.knots_u = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
    s.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
    const Vec2d along{std::cos(angle), std::sin(angle)};
    for (int i = 0; i < kAlong; ++i) {
        for (int j = 0; j < 4; ++j) {
            const double z = 3.0 * j + wave(random);
            const Vec2d p =
                along * (6.0 * i - 15.0) + left_normal(along) * (lean * z + 0.5 * wave(random));
            s.points.push_back({p.x, p.y, z});
            s.weights.push_back(1);
        }
    }
    return s;
}

// Points of the wall, 0.06 mm apart.
std::vector<Vec3d> points_of(const Surface& wall)
{
    constexpr int kAlong = 500;
    constexpr int kUp = 150;
    std::vector<Vec3d> out;
    for (int i = 0; i <= kAlong; ++i) {
        for (int j = 0; j <= kUp; ++j) {
            out.push_back(point_at(wall, 3.0 * i / kAlong, 1.0 * j / kUp));
        }
    }
    return out;
}

// mm: the least distance of the points from a ball or bull and its shank.
double clearance_from(const std::vector<Vec3d>& points, const Tool& tool, Vec3d tip)
{
    const double corner = tool.corner_radius;
    double least = kUnbounded;
    for (const Vec3d& p : points) {
        const double off = distance(in_plan(p), in_plan(tip)) - (tool.radius - corner);
        const double below = std::max(0.0, tip.z + corner - p.z);
        least = std::min(least, std::hypot(std::max(0.0, off), below) - corner);
    }
    return least;
}

TEST_GROUP(DropCutter){};

TEST(DropCutter, EndsWhereARotatedPatchDoes)
{
    for (const Step& step : kSteps) {
        for (const double angle : {0.0, 0.4, 0.8, 2.2}) {
            const DropCutter floor{
                {level_patch(60.0, 60.0, 0.0, kLow), level_patch(20.0, 14.0, angle, kHigh)},
                step.tool,
                2e-3};
            const Vec2d out{std::cos(angle), std::sin(angle)};
            for (int i = -10; i <= 10; ++i) {
                const Vec2d rim = out * 10.0 + left_normal(out) * (0.6 * i);
                CHECK(floor.tip_height(rim + out * (step.reach - 0.01)) > kLow + 1e-3);
                DOUBLES_EQUAL(kLow, floor.tip_height(rim + out * (step.reach + 0.01)), 2e-3);
            }
            // Past both sides of a corner.
            const Vec2d corner = out * 10.0 + left_normal(out) * 7.0;
            const Vec2d away = unit(out + left_normal(out));
            CHECK(floor.tip_height(corner + away * (step.reach - 0.01)) > kLow + 1e-3);
            DOUBLES_EQUAL(kLow, floor.tip_height(corner + away * (step.reach + 0.01)), 2e-3);
        }
    }
}

TEST(DropCutter, GivesTheClearanceBesideARotatedPatch)
{
    for (const Step& step : kSteps) {
        const double angle = 0.7;
        const DropCutter floor{
            {level_patch(60.0, 60.0, 0.0, kLow), level_patch(20.0, 14.0, angle, kHigh)},
            step.tool,
            2e-3};
        const Vec2d out{std::cos(angle), std::sin(angle)};
        const auto tip = [&](double beside, double along) {
            const Vec2d p = out * (10.0 + step.reach + beside) + left_normal(out) * along;
            return Vec3d{p.x, p.y, kLow + 0.003};
        };
        DOUBLES_EQUAL(0.0, floor.move_clearance(tip(0.01, -6.0), tip(0.01, 6.0)), 0.0);
        CHECK(floor.move_clearance(tip(-0.05, -6.0), tip(-0.05, 6.0)) < -1e-3);
    }
}

TEST(DropCutter, CoversNothingBesideARotatedPatch)
{
    const DropCutter floor{{level_patch(20.0, 14.0, 0.7, kHigh)}, kSteps[0].tool, 2e-3};
    const Vec2d out{std::cos(0.7), std::sin(0.7)};
    CHECK_TRUE(floor.covers(out * 9.9));
    CHECK_FALSE(floor.covers(out * 10.1));
}

// From 4 to 20 mm about the origin, with four corners.
Surface ring()
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.knots_u = {0, 0, 1, 2, 3, 4, 4};
    s.knots_v = {0, 0, 1, 1};
    s.size_u = 5;
    s.size_v = 2;
    for (const Vec2d way : {Vec2d{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}}) {
        s.points.push_back({4 * way.x, 4 * way.y, kLow});
        s.points.push_back({20 * way.x, 20 * way.y, kLow});
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

TEST(DropCutter, OfARingDoesNotCoverWhatIsInside)
{
    const std::vector<Surface> surfaces{ring()};
    const DropCutter floor{surfaces, kSteps[2].tool, 2e-3};
    const Vec2d corners[] = {{-7, -7}, {7, -7}, {7, 7}, {-7, 7}};
    Contour square;
    for (std::size_t k = 0; k < 4; ++k) {
        square.push_back(line_edge(corners[k], corners[(k + 1) % 4]));
    }
    const auto place = point_without_floor({{square}}, floor, surfaces, kRadius);
    CHECK(place.has_value());
    CHECK(std::abs(place->x) + std::abs(place->y) < 4);
}

// A wavy wall at an angle to the axes, from nearly vertical to overhanging. Bounded by boxes
// along the axes alone, a drop beside it halved thousands of pieces: most of the wall under the tool.
TEST(DropCutter, HalvesFewPiecesOfATurnedWall)
{
    constexpr unsigned kSeed = 11;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> between{-1.0, 1.0};
    for (const double lean : {0.12, 0.02, -0.05}) {  // mm in plan for each mm of height
        const double angle = 0.6 + 0.3 * between(random);
        const Surface wall = turned_wall(random, angle, lean);
        const std::vector<Vec3d> points = points_of(wall);
        constexpr double kAccuracy = 1e-4;
        constexpr int kDrops = 40;
        constexpr double kAbove = 0.02;  // mm: a piece five accuracies wide rises a few hundredths
        const Vec2d along{std::cos(angle), std::sin(angle)};
        for (const Tool& tool : {kSteps[1].tool, kSteps[2].tool}) {
            const DropCutter floor{{wall}, tool, kAccuracy};
            for (int k = 0; k < kDrops; ++k) {
                const double beside = (k % 2 == 0 ? 1.0 : -1.0) * (1.6 + 0.9 * between(random));
                const Vec2d at = along * (12.0 * between(random)) + left_normal(along) * beside;
                const double clear =
                    clearance_from(points, tool, {at.x, at.y, floor.tip_height(at)});
                CHECK(clear >= -1e-9);
                CHECK(clear <= kAbove);
            }
            CHECK(floor.halvings() < kDrops * 400);
        }
    }
}

// More halves than it keeps: it starts again, with equal results.
TEST(DropCutter, ManyQuestionsDoNotFillTheMemory)
{
    constexpr double kAccuracy = 1e-8;
    Surface bowl;
    bowl.degree_u = bowl.degree_v = 2;
    bowl.size_u = bowl.size_v = 3;
    bowl.knots_u = bowl.knots_v = {0, 0, 0, 1, 1, 1};
    bowl.weights.assign(9, 1.0);
    for (int k = 0; k < 9; ++k) {
        bowl.points.push_back({40.0 * (k / 3), 40.0 * (k % 3), k == 4 ? -30.0 : 0.0});
    }
    const DropCutter floor{{bowl}, kSteps[1].tool, kAccuracy};
    const auto place = [](int k) {
        return Vec2d{5.0 + std::fmod(k * 7.123456, 70.0), 5.0 + std::fmod(k * 11.654321, 70.0)};
    };
    constexpr int kAgain = 100;
    std::array<double, kAgain> before;
    for (int k = 0; k < kAgain; ++k) {
        before[static_cast<std::size_t>(k)] = floor.tip_height(place(k));
    }
    const std::size_t held = mallinfo2().uordblks + mallinfo2().hblkhd;
    for (int k = kAgain; k < 40000; ++k) {
        floor.drop(place(k));
    }
    CHECK(mallinfo2().uordblks + mallinfo2().hblkhd - held < 400'000'000);
    for (int k = 0; k < kAgain; ++k) {
        DOUBLES_EQUAL(before[static_cast<std::size_t>(k)], floor.tip_height(place(k)), kAccuracy);
    }
}

}  // namespace
}  // namespace cusp::test
