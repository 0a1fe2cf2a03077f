// Pits, grooves, walls and pockets finished by ends that can't touch all of them: what such an end could
// still remove is cut, by brute force and by the project's judge.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"
#include "host_tools/cam/steep_shallow/steep_shallow.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "tests/generators/faces_of_mesh.hpp"
#include "tests/generators/valley_parts.hpp"
#include "tests/judges/profile_judge.hpp"
#include "tests/judges/reachable_by_drops.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/temporary_folder.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

#include "tests/support/leaks_on_threads.hpp"

namespace cusp::test {

using namespace adaptive_isocurve;
using namespace steep_shallow;
using namespace job;
using namespace toolpath;

namespace {

constexpr int kJudged = 400;  // places of a part
constexpr double kOverBound = 1e-3;
constexpr double kGouged = 1e-6;

// A taper with a flat or a ball at its tip.
Tool random_end(Random& random)
{
    const double radius = uniform(random, 0.5, 1.5);
    Tool out{1, ToolShape::kFlat, radius, 0};
    switch (whole(random, 0, 3)) {
        case 0:
            return out;
        case 1:
            out.shape = ToolShape::kBull;
            out.corner_radius = radius * uniform(random, 0.1, 0.9);
            return out;
        case 2:
            out.corner_radius = radius * uniform(random, 0.2, 0.8);
            break;
        default:
            out.tip_radius = radius * uniform(random, 0.2, 0.8);
    }
    out.shape = ToolShape::kTaper;
    out.tip_angle = 2 * uniform(random, 0.05, 0.35);
    return out;
}

Job random_valley_job(Random& random)
{
    constexpr const Strategy* kStrategies[] = {&kAdaptiveIsocurve, &kParallelPlanes,
                                               &kSteepShallow};
    Job job = plain_job();
    job.tools = {random_end(random)};
    Operation operation;
    operation.strategy = kStrategies[whole(random, 0, 2)];
    operation.tool = job.tools.front();
    operation.part.mesh = valley_part(random);
    operation.tolerance.scallop = operation.tool.radius * std::pow(10.0, uniform(random, -1.5, -1));
    operation.tolerance.floor = operation.tolerance.plan = 0.2 * *operation.tolerance.scallop;
    job.stock_top = -kFar;
    for (const auto& t : operation.part.mesh) {
        job.stock_top = std::max({job.stock_top, t[0].z, t[1].z, t[2].z});
    }
    job.stock_top += 0.5;
    job.operations = {operation};
    return job;
}

std::vector<std::string> broken_by_verify(const Job& job, const PlannedOperation& planned)
{
    const TemporaryFolder folder;
    const std::string file = folder.file("valley.ngc");
    {
        std::ofstream out{file};
        write_program(out, {"valley", false, job.stock_top + job.clearance, {}}, {planned});
    }
    return verify::verify(job, file, {}, [](double) {}).broken;
}

std::string wrong_of(unsigned seed)
{
    Random random{seed};
    Job job = random_valley_job(random);
    const Triangles mesh = job.operations.front().part.mesh;
    if (whole(random, 0, 2) == 0) {
        job.operations.front().part.floor = faces_of(mesh);
        job.operations.front().part.mesh.clear();
    }
    const Operation& operation = job.operations.front();
    const PlannedOperation planned = operation.strategy->plan(job, operation).front();
    std::string wrong;
    for (const std::string& broken : broken_by_verify(job, planned)) {
        wrong += "seed " + std::to_string(seed) + ": verify: " + broken + "\n";
    }
    const MovesOfEnd moves{planned.path};
    const ReachableByDrops reachable{mesh, operation.tool, operation.tolerance.floor};
    const double bound = planned.stats.scallop_bound_mm + operation.tolerance.floor + kOverBound;
    for (int k = 0; k < kJudged; ++k) {
        const Vec3d place = random_place(
            random,
            mesh[static_cast<std::size_t>(whole(random, 0, static_cast<int>(mesh.size()) - 1))]);
        const double cut = moves.lowest(place);
        const double lowest = std::max(place.z, reachable.lowest_over(place));
        const bool gouged = cut < place.z - planned.stats.gouge_bound_mm - kGouged &&
                            reachable.top_over(place) <= place.z + kGouged;
        const Vec3d stays{place.x, place.y, lowest};
        if (gouged || (cut - lowest > bound && !is_cut_within(moves, stays, bound))) {
            return wrong + fmt::format(
                               "seed {}: {} at {:.4f} {:.4f}: part {:.4f}, cut {:.4f}, the "
                               "end could leave {:.4f}, bound {:.4f}\n",
                               seed, gouged ? "gouge" : "left", place.x, place.y, place.z, cut,
                               lowest, bound);
        }
    }
    return wrong;
}

}  // namespace

TEST_GROUP(LowestEndProperty){};

TEST(LowestEndProperty, NothingStaysThatTheEndCouldRemove)
{
    const std::string wrong = broken_cases(property_seed(1), property_cases(10), wrong_of);
    STRCMP_EQUAL("", wrong.c_str());
}

}  // namespace cusp::test
