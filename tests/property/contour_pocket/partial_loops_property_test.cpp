// Random steep hills in pockets: nothing is left above the scallop, and the path is shorter than
// that of whole loops as near as the hill needs.
#include <cmath>
#include <cstdio>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/judges/moves_judge.hpp"
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

constexpr double kSide = 50.0;  // mm
constexpr int kPoints = 48;     // of the floor, a side

Curve line_curve(Vec2d a, Vec2d b)
{
    return {1, {0.0, 0.0, 1.0, 1.0}, {{a.x, a.y, 0.0}, {b.x, b.y, 0.0}}, {1.0, 1.0}};
}

// A round hill with a flank of that slope on a level floor, both ends of the flank round.
struct Hill {
    Vec2d centre;
    double radius;  // of the flank's foot, mm
    double height;
    double slope;
};

double height_of(const Hill& hill, Vec2d p)
{
    constexpr double kRound = 2.5;  // mm
    const double up = (hill.radius - distance(p, hill.centre)) * hill.slope;
    const auto rounded = [](double z) {
        return 0.5 * (z + std::sqrt(z * z + kRound * kRound));
    };
    return rounded(up) - rounded(up - hill.height);
}

Surface floor_of(const Hill& hill)
{
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = s.size_v = kPoints;
    for (int k = 0; k < kPoints + 4; ++k) {
        s.knots_u.push_back(std::min(std::max(k - 3, 0), kPoints - 3));
    }
    s.knots_v = s.knots_u;
    const auto at = [&](int k) {
        const auto first = s.knots_u.begin() + k + 1;
        return kSide * ((first[0] + first[1] + first[2]) / (3.0 * (kPoints - 3)) - 0.5);
    };
    for (int i = 0; i < kPoints; ++i) {
        for (int j = 0; j < kPoints; ++j) {
            s.points.push_back({at(i), at(j), -10.0 + height_of(hill, {at(i), at(j)})});
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

Operation random_steep_pocket(Random& random)
{
    Hill hill;
    hill.centre = {uniform(random, -4.0, 4.0), uniform(random, -4.0, 4.0)};
    hill.radius = uniform(random, 8.0, 12.0);
    hill.height = uniform(random, 5.0, 8.0);
    hill.slope = uniform(random, 1.5, 3.0);
    constexpr double kHalf = 20.0;
    const Vec2d p[] = {{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}};
    const Loop boundary{line_curve(p[0], p[1]), line_curve(p[1], p[2]), line_curve(p[2], p[3]),
                        line_curve(p[3], p[0])};
    const double radius = uniform(random, 1.2, 2.0);
    Operation operation = random_pocket(random, {floor_of(hill)}, boundary,
                                        {1, ToolShape::kBall, radius, radius}, 0.1);
    operation.output = uniform(random, 0.0, 1.0) < 0.5 ? OutputForm::kLines : OutputForm::kArcs;
    operation.passes.direction_of_cut =
        uniform(random, 0.0, 1.0) < 0.5 ? CutDirection::kClimb : CutDirection::kConventional;
    return operation;
}

int partial_loops(const PlannedOperation& planned)
{
    const auto& counts = planned.stats.counts;
    const auto found = std::find_if(counts.begin(), counts.end(), [](const auto& count) {
        return count.first == "partial_loops";
    });
    return found == counts.end() ? 0 : static_cast<int>(found->second);
}

Region2d square_region()
{
    return {{{line_edge({-20.0, -20.0}, {20.0, -20.0}), line_edge({20.0, -20.0}, {20.0, 20.0}),
              line_edge({20.0, 20.0}, {-20.0, 20.0}), line_edge({-20.0, 20.0}, {-20.0, -20.0})}}};
}

TEST_GROUP(PartialLoopsOnSteepHills){};

TEST(PartialLoopsOnSteepHills, LeaveNothingOverTheScallop)
{
    constexpr unsigned kSeed = 1993;
    Random random{kSeed};
    int partial = 0;
    for (int i = 0; i < property_cases(3); ++i) {
        const Operation operation = random_steep_pocket(random);
        const PlannedOperation planned = planned_pocket(operation);
        partial += partial_loops(planned);
        const PocketVerdict verdict =
            judge_pocket(operation.part.floor, square_region(), planned.path, 1.0, 300);
        std::printf(
            "seed %u pocket %d: gouge %.4f left %.4f of %.4f, %d levels, %d partial loops\n", kSeed,
            i, verdict.floor_gouge, verdict.most_left, *operation.tolerance.scallop,
            planned.stats.levels, partial);
        CHECK(verdict.floor_gouge <= 1e-6);
        CHECK(verdict.most_left <= *operation.tolerance.scallop + 1e-3);
        DOUBLES_EQUAL(0.0, verdict.uncut, 0.0);
        LONGS_EQUAL(1, planned.stats.retracts);
    }
    CHECK(partial > 0);
}

TEST(PartialLoopsOnSteepHills, AreCutOnceAndNoDeeperThanAllowedAfterRoughing)
{
    constexpr unsigned kSeed = 1995;
    Random random{kSeed};
    int partial = 0;
    for (int i = 0; i < property_cases(2); ++i) {
        Job job;
        job.file = "job";
        job.stock_top = 1.0;
        job.clearance = 5.0;
        Operation operation = random_steep_pocket(random);
        operation.tools = {operation.tool};
        operation.levels.max_depth = uniform(random, 2.0, 4.0);
        operation.passes.allowance = i % 2 == 0 ? 0.0 : uniform(random, 0.1, 0.4);
        const std::vector<PlannedOperation> planned = plan_contour_pocket(job, operation);
        LONGS_EQUAL(2, planned.size());
        const Region2d region = square_region();
        MovesJudge moves{region, job.stock_top, operation.tool.radius, operation.tool.radius};
        const double clearance = job.stock_top + job.clearance;
        moves.cut(planned.front().path, clearance, true);
        const MovesVerdict finish = moves.cut(planned.back().path, clearance, true);
        const PocketVerdict verdict =
            judge_pocket(operation.part.floor, region, planned.back().path, 1.0, 300);
        partial += partial_loops(planned.back());
        std::printf(
            "seed %u layered %d: gouge %.4f left %.4f of %.4f, %d partial loops, deepest "
            "%.3f of %.3f\n",
            kSeed, i, verdict.floor_gouge, verdict.most_left, *operation.tolerance.scallop,
            partial_loops(planned.back()), finish.deepest, *operation.levels.max_depth);
        CHECK(verdict.floor_gouge <= 1e-6);
        CHECK(verdict.most_left <= *operation.tolerance.scallop + 1e-3);
        DOUBLES_EQUAL(0.0, verdict.uncut, 0.0);
        CHECK(finish.deepest <= *operation.levels.max_depth * 1.02 + 0.03);
        CHECK(finish.rapid_cut <= 0.05);
        LONGS_EQUAL(1, planned.back().stats.retracts);
    }
    CHECK(partial > 0);
}

}  // namespace
}  // namespace cusp::test
