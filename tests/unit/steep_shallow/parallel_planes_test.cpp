// Stock left by parallel planes, from the path that was cut.
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/finishing/swept_volume.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/support/refusal.hpp"
#include "tests/unit/adaptive_isocurve/small_models.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::steep_shallow;
using namespace cusp::finishing;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::test;
using namespace cusp::toolpath;
using cusp::test::refusal;

namespace {

PlannedOperation planes_over(const Job& job)
{
    return plan_parallel_planes(job, job.operations.front()).front();
}

std::unique_ptr<SweptVolume> cut_by(const Toolpath& path)
{
    auto swept = std::make_unique<SweptVolume>(path.tool.radius, path.tool.radius);
    std::vector<Vec3d> tips{end_of(path.moves.front())};
    for (const ToolMove& move : path.moves) {
        const std::vector<Vec3d> next = points_of(move, tips.back(), 1e-4);
        tips.insert(tips.end(), next.begin(), next.end());
    }
    swept->add(tips);
    return swept;
}

// The largest height left over the surface along the axis, its rims included.
double most_over(const SweptVolume& swept, const Surface& s)
{
    constexpr int kLooks = 150;
    double most = 0;
    for (int i = 0; i <= kLooks; ++i) {
        for (int j = 0; j <= kLooks; ++j) {
            const Vec3d p = point_at(s, s.u_begin() + (s.u_end() - s.u_begin()) * i / kLooks,
                                     s.v_begin() + (s.v_end() - s.v_begin()) * j / kLooks);
            most = std::max(most, swept.lowest(p.x, p.y).height - p.z);
        }
    }
    return most;
}

// Concave along x, with little more than the radius 2 of the ball; its sides rise to 30 degrees.
Surface hollow()
{
    constexpr double kRadius = 2.5;
    const double half = std::sin(std::acos(-1.0) / 6);
    const double rise = std::sqrt(1 - half * half);
    Surface s;
    s.degree_u = 1;
    s.degree_v = 2;
    s.knots_u = {0, 0, 1, 1};
    s.knots_v = {0, 0, 0, 1, 1, 1};
    s.size_u = 2;
    s.size_v = 3;
    for (const double x : {0.0, 6.0}) {
        s.points.push_back({x, -kRadius * half, -kRadius * rise});
        s.points.push_back({x, 0, -kRadius / rise});
        s.points.push_back({x, kRadius * half, -kRadius * rise});
        s.weights.insert(s.weights.end(), {1, rise, 1});
    }
    return s;
}

// Level along y, and rises 80 degrees along x.
constexpr double kSteepRise = 5.67;
Surface steep() { return plane({0, 0, -kSteepRise}, {0, 6, -kSteepRise}, {1, 0, 0}, {1, 6, 0}); }

// A job along y: the planes are a step apart where the ground is steepest.
Job steep_job(bool as_mesh)
{
    Job job = job_for({steep()}, kParallelPlanes);
    Operation& operation = job.operations.front();
    job::finish_keys(operation).direction = 'v';
    operation.tolerance.scallop = 0.05;
    if (as_mesh) {
        const std::vector<Vec3d> at = operation.part.floor.front().points;
        operation.part.mesh = {{at[0], at[2], at[3]}, {at[0], at[3], at[1]}};
        operation.part.floor.clear();
    }
    return job;
}

// A wall from y = -0.5 to 0 without ground at its foot. Ground begins so far off that a ball of radius 2
// beside the wall rests on its border. The faces are turned to each other: cells look at that side only.
std::vector<Surface> wall_beside_ground()
{
    return {plane({0, 1.9, 0}, {0, 10, 0}, {8, 1.9, 0}, {8, 10, 0}),
            plane({8, 0, -1}, {8, 0, 4}, {0, 0, -1}, {0, 0, 4}),
            plane({0, -0.5, -1}, {0, -0.5, 4}, {8, -0.5, -1}, {8, -0.5, 4})};
}

// mm: what stays beside the wall at half its length, of tips below its top.
double left_beside_wall(const Toolpath& path)
{
    double least = kInfinite;
    Vec3d at = end_of(path.moves.front());
    for (const ToolMove& move : path.moves) {
        for (const Vec3d& to : points_of(move, at, 1e-4)) {
            if (move.kind != MoveKind::kRapid && std::max(at.z, to.z) < 1 &&
                std::min(at.x, to.x) <= 4 && std::max(at.x, to.x) >= 4) {
                least = std::min({least, at.y, to.y});
            }
            at = to;
        }
    }
    return least - path.tool.radius;
}

// mm, square to the slope.
double most_over_steep(const PlannedOperation& planned)
{
    return most_over(*cut_by(planned.path), steep()) / std::sqrt(1 + kSteepRise * kSteepRise);
}

}  // namespace

TEST_GROUP(ParallelPlanes){};

TEST(ParallelPlanes, KeepTheScallopInAHollow)
{
    // Centres are five times closer than contacts.
    Job job = job_for({hollow()}, kParallelPlanes);
    job.operations.front().tolerance.scallop = 0.05;
    const PlannedOperation planned = planes_over(job);
    DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-12);
    CHECK(most_over(*cut_by(planned.path), hollow()) <= 0.05 / std::cos(std::acos(-1.0) / 6));
    DOUBLES_EQUAL(0, planned.stats.gouge_bound_mm, 1e-6);
}

// Planes for 75 degrees leave too much at 80.
TEST(ParallelPlanes, GetThePassesThatTheyLackOnSteepGround)
{
    for (const bool as_mesh : {false, true}) {
        const PlannedOperation planned = planes_over(steep_job(as_mesh));
        DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-9);
        CHECK(most_over_steep(planned) <= 0.05 + 1e-6);
        LONGS_EQUAL(0, planned.stats.warnings.size());
    }
}

TEST(ParallelPlanes, KeepAProvedBoundWhereTheDistanceIsGiven)
{
    for (const bool as_mesh : {false, true}) {
        Job job = steep_job(as_mesh);
        job.operations.front().passes.step_over = 0.3;
        const PlannedOperation planned = planes_over(job);
        const double left = most_over_steep(planned);
        CHECK(left > 0.05);
        CHECK(planned.stats.scallop_bound_mm >= left - 1e-6);
        CHECK(planned.stats.scallop_bound_mm < 2 * left);
    }
}

// Over the ground itself hardly a tenth of that is left.
TEST(ParallelPlanes, ClaimWhatStaysBesideAWallWhereTheDistanceIsGiven)
{
    Job job = job_for(wall_beside_ground(), kParallelPlanes);
    Operation& operation = job.operations.front();
    operation.passes.step_over = 0.8;
    operation.tolerance.scallop.reset();
    const PlannedOperation planned = planes_over(job);
    const double left = left_beside_wall(planned.path);
    CHECK(left > 0.2);
    CHECK(planned.stats.scallop_bound_mm >= left);
    CHECK(planned.stats.scallop_bound_mm < 1.2 * left);
}

// With a scallop there is a pass along the wall.
TEST(ParallelPlanes, CutBesideAWallWhereTheScallopIsGiven)
{
    Job job = job_for(wall_beside_ground(), kParallelPlanes);
    job.operations.front().tolerance.scallop = 0.05;
    const PlannedOperation planned = planes_over(job);
    CHECK(left_beside_wall(planned.path) <= 0.05);
    DOUBLES_EQUAL(0.05, planned.stats.scallop_bound_mm, 1e-12);
}

TEST(ParallelPlanes, ReachTheRimsOfASlope)
{
    // The ball is beyond these.
    const Surface slope = wall(9, 0);
    Surface flat = slope;
    for (Vec3d& p : flat.points) {
        p.x = 4 * p.x;
        p.z += 0.1 * p.y;
    }
    for (const char direction : {'u', 'v'}) {
        Job job = job_for({flat}, kParallelPlanes);
        job::finish_keys(job.operations.front()).direction = direction;
        const PlannedOperation planned = planes_over(job);
        DOUBLES_EQUAL(0.2, planned.stats.scallop_bound_mm, 1e-12);
        CHECK(most_over(*cut_by(planned.path), flat) <= 0.2 * std::sqrt(1 + 0.25 + 0.01));
    }
}

TEST(ParallelPlanes, ArePutAsTheSurfaceAsksNotItsPole)
{
    // The curvature at a pole is rounding: from none to infinite.
    Job job = job_for({bowl()}, kParallelPlanes);
    job.operations.front().tolerance.scallop = 0.1;
    const PlannedOperation planned = planes_over(job);
    CHECK(planned.stats.passes > 10);
    CHECK(planned.stats.passes < 200);
    CHECK(cut_by(planned.path)->lowest(7.3, -4.1).height < -5.37 + 0.11);
}

TEST(ParallelPlanes, RunOverTheTrianglesOfAMesh)
{
    Job job = job_for({}, kParallelPlanes);
    Operation& operation = job.operations.front();
    const Vec3d a{0, 0, 0}, b{10, 0, 10};
    const Vec3d c{10, 10, 15}, d{0, 10, 5};
    operation.part.mesh = {{a, b, c}, {a, c, d}};
    const PlannedOperation planned = planes_over(job);
    const auto volume = cut_by(planned.path);
    const SweptVolume& swept = *volume;
    for (const Vec3d p : {a, b, c, d, (a + d) * 0.5, (a + b) * 0.5}) {
        const Vec3d in = p + ((a + c) * 0.5 - p) * 1e-3;
        CHECK((swept.lowest(in.x, in.y).height - in.z) / std::sqrt(1 + 1 + 0.25) <= 0.2);
    }
    DOUBLES_EQUAL(0, planned.stats.gouge_bound_mm, 1e-6);
}

// Points were a millimetre apart on a part of metres, and a part of one millimetre had only two
// samples.
TEST(ParallelPlanes, TakeAsManyPointsHoweverLargeThePart)
{
    const auto planned_at = [](double scale) {
        std::mt19937 random{7};
        Surface s = bumps(random, 2);
        for (Vec3d& p : s.points) {
            p = p * scale;
        }
        Job job = job_for({s}, kParallelPlanes);
        job.clearance *= scale;
        Operation& operation = job.operations.front();
        operation.tool.radius *= scale;
        operation.tool.corner_radius *= scale;
        operation.tolerance.scallop = *operation.tolerance.scallop * scale;
        operation.tolerance.floor *= scale;
        operation.tolerance.plan *= scale;
        return planes_over(job);
    };
    const PlannedOperation usual = planned_at(1);
    const double length = count_of(usual, "pass_length_mm");
    for (const double scale : {0.02, 100.0}) {
        const PlannedOperation scaled = planned_at(scale);
        LONGS_EQUAL(usual.stats.passes, scaled.stats.passes);
        CHECK(scaled.stats.cl_points < 1.1 * usual.stats.cl_points);
        CHECK(scaled.stats.cl_points > 0.9 * usual.stats.cl_points);
        DOUBLES_EQUAL(length, count_of(scaled, "pass_length_mm") / scale, 0.002 * length);
    }
}

TEST(ParallelPlanes, OverASpeckAreFew)
{
    // Beyond its rims they are a step apart, not as far as over it.
    Job job = job_for({}, kParallelPlanes);
    job.operations.front().part.mesh.push_back(
        {Vec3d{0, 0, 0}, Vec3d{1e-5, 0, 0}, Vec3d{0, 1e-5, 0}});
    try {
        CHECK(planes_over(job).stats.passes < 20);
    } catch (const InputError&) {
        // it is no larger than a point, and may be refused
    }
}

TEST(ParallelPlanes, TooManyOrTooFarApartAreRefused)
{
    Job job = job_for({wall(9, 0)}, kParallelPlanes);
    job.operations.front().passes.step_over = 4;
    STRCMP_CONTAINS("step_over is 4 mm", refusal([&] { planes_over(job); }).c_str());
    job.operations.front().passes.step_over = 5e-4;
    const std::string said = refusal([&] { planes_over(job); });
    STRCMP_CONTAINS("step_over", said.c_str());
    STRCMP_CONTAINS("over a part of 20 mm", said.c_str());
    STRCMP_CONTAINS("at most 20000", said.c_str());
}
