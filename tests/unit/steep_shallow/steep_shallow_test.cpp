// Levels over steep ground, planes over the rest, in the area of the operation.
#include "host_tools/cam/steep_shallow/steep_shallow.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/finish_keys.hpp"
#include "tests/support/example_parts.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/refusal.hpp"
#include "tests/unit/adaptive_isocurve/small_models.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::steep_shallow;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

using Mesh = std::vector<std::array<Vec3d, 3>>;

// A hill with a level top of radius 4 and a side of 60 degrees, 8 mm high, on a level square: all its
// contacts and what stays between them are known.
constexpr double kTopRadius = 4;
constexpr double kHeight = 8;
constexpr double kHalf = 16;
constexpr int kSides = 96;
const double kFootRadius = kTopRadius + kHeight / std::tan(kPi / 3);

Mesh hill()
{
    Mesh out;
    const auto at = [](int k, double radius, double z) {
        const double turn = 2 * kPi * k / kSides;
        return Vec3d{radius * std::cos(turn), radius * std::sin(turn), z};
    };
    const auto rim = [](int k) {
        const double turn = 2 * kPi * k / kSides;
        const double reach = kHalf / std::max(std::abs(std::cos(turn)), std::abs(std::sin(turn)));
        return Vec3d{reach * std::cos(turn), reach * std::sin(turn), -kHeight};
    };
    for (int k = 0; k < kSides; ++k) {
        const Vec3d a = at(k, kTopRadius, 0), b = at(k + 1, kTopRadius, 0);
        const Vec3d c = at(k, kFootRadius, -kHeight), d = at(k + 1, kFootRadius, -kHeight);
        out.push_back({Vec3d{0, 0, 0}, a, b});
        out.push_back({a, c, d});
        out.push_back({a, d, b});
        out.push_back({c, rim(k), rim(k + 1)});
        out.push_back({c, rim(k + 1), d});
    }
    return out;
}

Job hill_job(const Strategy& strategy)
{
    Job job = job_for({}, strategy);
    Operation& operation = job.operations.front();
    operation.part.mesh = hill();
    operation.tolerance.scallop = 0.05;
    operation.tolerance.floor = operation.tolerance.plan = 0.005;
    job.stock_top = 0.5;
    return job;
}

Loop square(double low, double high)
{
    return loop_of({{low, low}, {high, low}, {high, high}, {low, high}});
}

// All tips of cuts, no farther apart than a tenth of a millimetre.
std::vector<Vec3d> cut_tips(const PlannedOperation& planned)
{
    std::vector<Vec3d> out;
    Vec3d at = end_of(planned.path.moves.front());
    for (const ToolMove& move : planned.path.moves) {
        for (const Vec3d& to : points_of(move, at, 1e-4)) {
            const int parts = 1 + static_cast<int>(norm(to - at) / 0.1);
            for (int k = 0; k <= parts && move.kind == MoveKind::kCut; ++k) {
                out.push_back(at + (to - at) * (static_cast<double>(k) / parts));
            }
            at = to;
        }
    }
    return out;
}

// mm: the stock left over a place, straight up, by brute force over all tips.
double left_over(const std::vector<Vec3d>& tips, double radius, Vec3d place)
{
    double least = kInfinite;
    for (const Vec3d& tip : tips) {
        const double away = std::hypot(tip.x - place.x, tip.y - place.y);
        if (away < radius) {
            least = std::min(least, tip.z + radius - std::sqrt(radius * radius - away * away));
        }
    }
    return least - place.z;
}

// mm: the most that stays on the side of the hill, square to it, but for what the tool can't reach.
double most_on_side(const PlannedOperation& planned)
{
    const std::vector<Vec3d> tips = cut_tips(planned);
    const double radius = planned.path.tool.radius;
    double most = 0;
    for (int k = 0; k < 40; ++k) {
        for (int j = 1; j < 40; ++j) {
            const double turn = 2 * kPi * (k + 0.37) / 40;
            const double down = (kHeight - 2.0) * j / 40;
            const double away = kTopRadius + down / std::tan(kPi / 3);
            const Vec3d place{away * std::cos(turn), away * std::sin(turn), -down};
            most = std::max(most, left_over(tips, radius, place) * std::cos(kPi / 3));
        }
    }
    return most;
}

}  // namespace

TEST_GROUP(SteepShallow){};

TEST(SteepShallow, LevelsKeepTheScallopOnTheSideOfAHill)
{
    for (const bool spiral : {false, true}) {
        Job job = hill_job(kWaterline);
        finish_keys(job.operations.front()).range.least_slope = 30;
        finish_keys(job.operations.front()).spiral = spiral;
        const PlannedOperation planned = plan_waterline(job, job.operations.front()).front();
        // Tips are at most a tenth of a millimetre apart, facets off the cone by 0.005 mm.
        CHECK(most_on_side(planned) <= 0.05 + 0.006);
        DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-9);
        DOUBLES_EQUAL(0, planned.stats.gouge_bound_mm, 1e-6);
        // Levels lie a stepover of 0.88 mm apart along the side, 9.2 mm long.
        CHECK(planned.stats.passes <= (spiral ? 6 : 24));
        // Nothing is cut over the level ground but beside the hill.
        for (const Vec3d& tip : cut_tips(planned)) {
            CHECK(std::hypot(tip.x, tip.y) < kFootRadius + 4);
            CHECK(std::hypot(tip.x, tip.y) > kTopRadius - 1.5);
        }
    }
}

TEST(SteepShallow, BothKeepOneScallopEverywhere)
{
    Job job = hill_job(kSteepShallow);
    const PlannedOperation planned = plan_steep_shallow(job, job.operations.front()).front();
    CHECK(most_on_side(planned) <= 0.05 + 0.006);
    DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-9);
    const std::vector<Vec3d> tips = cut_tips(planned);
    for (const Vec3d place :
         {Vec3d{0, 0, 0}, Vec3d{14, 3, -kHeight}, Vec3d{-11, -12.3, -kHeight}}) {
        CHECK(left_over(tips, planned.path.tool.radius, place) <= 0.05 + 1e-3);
    }
}

// Planes over all of the hill are as dense on level ground as its side asks.
TEST(SteepShallow, BothAreShorterThanPlanesAlone)
{
    Job job = hill_job(kSteepShallow);
    const double both =
        measure(plan_steep_shallow(job, job.operations.front()).front().path, {}).cut_length_mm;
    const double planes =
        measure(plan_parallel_planes(job, job.operations.front()).front().path, {}).cut_length_mm;
    CHECK(both < 0.9 * planes);
}

TEST(SteepShallow, AllStayInTheBoundaryAndOffIslands)
{
    for (const Strategy* strategy : {&kParallelPlanes, &kWaterline, &kSteepShallow}) {
        Job job = hill_job(*strategy);
        Operation& operation = job.operations.front();
        operation.outline.boundary = square(-2, 12);
        operation.outline.islands = {square(5, 7)};
        const PlannedOperation planned = strategy->plan(job, operation).front();
        const double radius = operation.tool.radius;
        const double beyond = 1.0;  // a stepover of 0.88 mm, and the margin
        for (const Vec3d& tip : cut_tips(planned)) {
            // On level ground the tool touches straight below its tip, on the side beside it.
            const double out = radius * std::sin(kPi / 3) + beyond;
            CHECK(tip.x > -2 - out && tip.x < 12 + out && tip.y > -2 - out && tip.y < 12 + out);
            const bool on_level = std::hypot(tip.x, tip.y) > kFootRadius + 2;
            CHECK(!(on_level && tip.x > 5 + beyond && tip.x < 7 - beyond && tip.y > 5 + beyond &&
                    tip.y < 7 - beyond));
        }
        CHECK(planned.stats.passes > 3);
        DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-9);
    }
}

TEST(SteepShallow, PlanesKeepToTheirSlopesAndHeights)
{
    Job job = hill_job(kParallelPlanes);
    Operation& operation = job.operations.front();
    finish_keys(operation).range.most_slope = 45;
    finish_keys(operation).range.low = -kHeight / 2;
    const PlannedOperation planned = plan_parallel_planes(job, operation).front();
    for (const Vec3d& tip : cut_tips(planned)) {
        // A step over the rim at 45 degrees, and down the side.
        CHECK(tip.z > -2.2);
        CHECK(std::hypot(tip.x, tip.y) < kTopRadius + 2.5);
    }
    DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-9);
    CHECK(left_over(cut_tips(planned), planned.path.tool.radius, {3.5, 0.4, 0}) <= 0.051);
}

// The same part, turned by an angle with its planes, has the same passes.
TEST(SteepShallow, PlanesRunAtAnyAngle)
{
    Job job = hill_job(kParallelPlanes);
    Operation& operation = job.operations.front();
    finish_keys(operation).plane_angle = 30;
    const PlannedOperation planned = plan_parallel_planes(job, operation).front();
    const Vec2d along{std::cos(kPi / 6), std::sin(kPi / 6)};
    double along_planes = 0;
    double all = 0;
    Vec3d at = end_of(planned.path.moves.front());
    for (const ToolMove& move : planned.path.moves) {
        const Vec3d to = end_of(move);
        if (move.kind == MoveKind::kCut) {
            const double length = std::hypot(to.x - at.x, to.y - at.y);
            all += length;
            along_planes +=
                std::abs(dot(in_plan(to) - in_plan(at), along)) > 0.999 * length ? length : 0;
        }
        at = to;
    }
    CHECK(along_planes > 0.8 * all);
    DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-9);
}

// Its slopes are 28 degrees at most; a ball beside its trimmed rims touches these from all sides.
TEST(SteepShallow, LevelsTakeNoRimForGround)
{
    Job job = job_for({example_part("trimmed-dome.json")}, kWaterline);
    Operation& operation = job.operations.front();
    finish_keys(operation).range.least_slope = 45;
    STRCMP_CONTAINS("inside boundary, slopes and heights",
                    refusal([&] { plan_waterline(job, operation); }).c_str());
}

TEST(SteepShallow, RefusesAnAreaWithoutGround)
{
    Job job = hill_job(kWaterline);
    Operation& operation = job.operations.front();
    finish_keys(operation).range.least_slope = 70;
    finish_keys(operation).range.most_slope = 80;
    STRCMP_CONTAINS("inside boundary, slopes and heights",
                    refusal([&] { plan_waterline(job, operation); }).c_str());
}
