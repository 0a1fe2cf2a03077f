// Random polyhedra finished by flat, bull and tapered ends, judged by brute force: no move cuts the part
// with any of its profile, no place that the end can touch keeps more than the plan claims, and places
// that it can't touch keep no more than it measured.
#include <cmath>
#include <cstdio>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"
#include "host_tools/cam/steep_shallow/steep_shallow.hpp"
#include "tests/generators/random_polyhedra.hpp"
#include "tests/judges/ball_on_triangles.hpp"
#include "tests/judges/profile_judge.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_isocurve;
using namespace steep_shallow;
using namespace job;
using namespace toolpath;

namespace {

constexpr int kJudged = 600;      // places of a part
constexpr double kGouged = 1e-6;  // mm
constexpr double kOverClaim = 1e-3;
constexpr double kMeasuredMore = 1.25;  // between the places that are measured
constexpr double kMeasuredNear = 0.1;   // radii: likewise
constexpr double kSteepest = 0.02;      // z of the normal of places that are judged

Tool random_end(Random& random, ToolShape shape)
{
    const double radius = uniform(random, 0.5, 2.5);
    Tool out{1, shape, radius, 0};
    if (shape == ToolShape::kBull) {
        out.corner_radius = radius * uniform(random, 0.1, 0.9);
    }
    if (shape == ToolShape::kTaper) {
        out.corner_radius = radius * uniform(random, 0.2, 0.8);
        out.tip_angle = 2 * uniform(random, 0.05, 0.4);
    }
    return out;
}

Job random_end_job(Random& random, ToolShape shape, const Strategy& strategy)
{
    Job job = plain_job();
    job.tools = {random_end(random, shape)};
    Operation operation;
    operation.strategy = &strategy;
    operation.part.mesh = random_polyhedron(random);
    operation.tool = job.tools.front();
    operation.tolerance.scallop = operation.tool.radius * std::pow(10.0, uniform(random, -1.7, -1));
    operation.tolerance.floor = operation.tolerance.plan =
        *operation.tolerance.scallop * uniform(random, 0.1, 0.4);
    job.stock_top = -kNothing;
    for (const auto& t : operation.part.mesh) {
        job.stock_top = std::max({job.stock_top, t[0].z, t[1].z, t[2].z});
    }
    job.stock_top += 0.5;
    job.operations = {operation};
    return job;
}

struct Found {
    double gouge{};  // mm, straight down
    double left{};   // mm over the claim, where the end can touch
    double
        unmeasured{};  // mm that places keep at least which it can't touch, over what was measured
    int touched{};
    Vec3d place{};
};

Found judged(Random& random, const Operation& operation, const PlannedOperation& planned)
{
    Found out;
    const Triangles& mesh = operation.part.mesh;
    const MovesOfEnd moves{planned.path};
    const SampledPart part{mesh};
    const BallOnTriangles tops{mesh};
    const double bound = planned.stats.scallop_bound_mm + kOverClaim;
    const Tool thick = thicker(operation.tool, operation.tolerance.floor + kSamplePitch);
    const double far = kMeasuredMore * planned.stats.left_measured_mm.value_or(0) +
                       kMeasuredNear * operation.tool.radius + bound;
    for (int k = 0; k < kJudged; ++k) {
        const auto& t =
            mesh[static_cast<std::size_t>(whole(random, 0, static_cast<int>(mesh.size()) - 1))];
        const Vec3d place = random_place(random, t);
        const Vec3d normal = BallOnTriangles::normal(t);
        out.gouge = std::max(out.gouge, place.z - moves.lowest(place));
        if (normal.z < kSteepest || tops.top(place.x, place.y) > place.z + 1e-6 ||
            normal.z < std::sin(0.5 * operation.tool.tip_angle) + 0.01) {
            continue;
        }
        if (part.is_clear(thick, touching_tip(thick, place, normal))) {
            ++out.touched;
            if (!moves.removes(place + normal * bound) &&
                (moves.lowest(place) - place.z) * normal.z > bound && out.left == 0) {
                out.left = (moves.lowest(place) - place.z) * normal.z - bound;
                out.place = place;
            }
        } else if (planned.stats.left_measured_mm && far < operation.tool.radius &&
                   !is_cut_within(moves, place, far)) {
            out.unmeasured = far;
            out.place = place;
        }
    }
    return out;
}

int broken(const Strategy& strategy, ToolShape shape, int usual)
{
    int bad = 0;
    int touched = 0;
    const unsigned first = property_seed(1);
    for (unsigned seed = first; seed < first + static_cast<unsigned>(property_cases(usual));
         ++seed) {
        Random random{seed};
        const Job job = random_end_job(random, shape, strategy);
        const Operation& operation = job.operations.front();
        const PlannedOperation planned = strategy.plan(job, operation).front();
        const Found found = judged(random, operation, planned);
        touched += found.touched;
        if (found.gouge > planned.stats.gouge_bound_mm + kGouged || found.left > 0 ||
            found.unmeasured > 0) {
            ++bad;
            std::printf(
                "seed %u FAILS: radius %.3f corner %.3f taper %.3f, claimed %.4f, measured %.4f; "
                "gouge %.6f, left %.4f over it, unmeasured %.4f, at (%.4f %.4f %.4f)\n",
                seed, operation.tool.radius, operation.tool.corner_radius, operation.tool.tip_angle,
                planned.stats.scallop_bound_mm, planned.stats.left_measured_mm.value_or(0),
                found.gouge, found.left, found.unmeasured, found.place.x, found.place.y,
                found.place.z);
        }
    }
    std::printf("%d places touched\n", touched);
    CHECK(touched > 20);
    return bad;
}

}  // namespace

TEST_GROUP(EveryEndProperty){};

TEST(EveryEndProperty, HoldsForFlatEnds)
{
    LONGS_EQUAL(0, broken(kAdaptiveIsocurve, ToolShape::kFlat, 2));
    LONGS_EQUAL(0, broken(kParallelPlanes, ToolShape::kFlat, 2));
    LONGS_EQUAL(0, broken(kSteepShallow, ToolShape::kFlat, 2));
}

TEST(EveryEndProperty, HoldsForBullEnds)
{
    LONGS_EQUAL(0, broken(kAdaptiveIsocurve, ToolShape::kBull, 2));
    LONGS_EQUAL(0, broken(kParallelPlanes, ToolShape::kBull, 2));
    LONGS_EQUAL(0, broken(kSteepShallow, ToolShape::kBull, 2));
}

TEST(EveryEndProperty, HoldsForTapers)
{
    LONGS_EQUAL(0, broken(kAdaptiveIsocurve, ToolShape::kTaper, 2));
    LONGS_EQUAL(0, broken(kParallelPlanes, ToolShape::kTaper, 2));
    LONGS_EQUAL(0, broken(kSteepShallow, ToolShape::kTaper, 2));
}

}  // namespace cusp::test
