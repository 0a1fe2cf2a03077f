// Whole plans, judged by the certified distance of densely sampled points of the path.
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/finishing/swept_volume.hpp"
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/support/recorded_progress.hpp"
#include "tests/unit/adaptive_isocurve/small_models.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using cusp::steep_shallow::plan_parallel_planes;
using namespace cusp::finishing;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

// All cuts of the path.
std::unique_ptr<SweptVolume> swept_by(const Toolpath& path)
{
    auto swept = std::make_unique<SweptVolume>(path.tool.radius, path.tool.radius);
    std::vector<Vec3d> tips;
    for (const ToolMove& move : path.moves) {
        if (!tips.empty()) {
            const std::vector<Vec3d> next = points_of(move, tips.back(), 1e-4);
            tips.insert(tips.end(), next.begin(), next.end());
        } else {
            tips.push_back(end_of(move));
        }
    }
    swept->add(tips);
    return swept;
}

// The deepest cut into the model over the whole path, rapids included.
double deepest_cut(const Toolpath& path, const std::vector<Surface>& floor)
{
    const PartModel model{floor};
    Vec3d at = end_of(path.moves.front());
    double deepest = 0;
    for (const ToolMove& move : path.moves) {
        for (const Vec3d next : points_of(move, at, 1e-5)) {
            const int parts = 1 + static_cast<int>(norm(next - at) / 0.3);
            for (int k = 1; k <= parts; ++k) {
                const Vec3d tip = at + (next - at) * (static_cast<double>(k) / parts);
                deepest = std::max(deepest, -model.distance(path.tool, tip, 0).distance);
            }
            at = next;
        }
    }
    return deepest;
}

// For each run of cuts: the vector from start to end, and its middle.
std::vector<Vec3d> pass_middles(const Toolpath& path)
{
    std::vector<Vec3d> out;
    Vec3d at;
    Vec3d start;
    bool cutting = false;
    for (const ToolMove& move : path.moves) {
        const bool cuts = move.kind == MoveKind::kCut;
        if (cuts != cutting) {
            if (!cuts) {
                out.push_back(at - start);
                out.push_back((at + start) * 0.5);
            }
            start = at;
            cutting = cuts;
        }
        at = end_of(move);
    }
    return out;
}

}  // namespace

TEST_GROUP(AdaptiveIsocurve)
{
    std::mt19937 random{5};
    std::vector<Surface> floor{bumps(random, 6), wall(9, 9)};
    Job job = job_for(floor, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    Operation& operation = job.operations.front();
};

TEST(AdaptiveIsocurve, NeverEntersAModelOfSeveralSurfaces)
{
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    DOUBLES_EQUAL(0, planned.stats.gouge_bound_mm, 1e-9);
    CHECK(deepest_cut(planned.path, floor) <= 1e-6);
    CHECK(planned.stats.scallop_bound_mm <= 0.2);
}

TEST(AdaptiveIsocurve, LeavesNoSliverOverTheOpenRimOfAnUprightWall)
{
    // Otherwise a sliver as thick as the one-sided tolerance would remain up to the stock's top.
    const Job made = job_for({upright_rim()}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    const auto planned = plan_adaptive_isocurve(made, made.operations.front());
    const auto volume = swept_by(planned.front().path);
    const SweptVolume& swept = *volume;
    for (const double y : {0.1, 2.0, 5.9}) {
        for (const double in : {1e-4, 0.002, 0.01, 0.019}) {
            CHECK(swept.lowest(5 - in, y).height < 0.025);
        }
    }
    DOUBLES_EQUAL(0, deepest_cut(planned.front().path, made.operations.front().part.floor), 1e-6);
}

TEST(AdaptiveIsocurve, SaysWhatATwoSidedToleranceLeavesBesideEdges)
{
    Job valley = job_for({trough()}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    valley.operations[0].tolerance.side = ToleranceSide::kBoth;
    valley.operations[0].tolerance.scallop = 0.1;
    const OperationStats stats = plan_adaptive_isocurve(valley, valley.operations[0]).front().stats;
    DOUBLES_EQUAL(0.1, stats.scallop_bound_mm, 1e-9);
    CHECK(stats.counts.back().first == "left_beside_edges_mm");
    CHECK(stats.counts.back().second > 0.1);
}

TEST(AdaptiveIsocurve, RowsOverASlopedMeshReachItsRims)
{
    // The ball is beyond the rims, the lower one along x and those along y, where it touches them.
    Job made = job_for({}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    Operation& slope = made.operations.front();
    const Vec3d a{0, 0, 0}, b{10, 0, 10};
    const Vec3d c{10, 10, 15}, d{0, 10, 5};
    slope.part.mesh = {{a, b, c}, {a, c, d}};
    const PlannedOperation planned = plan_adaptive_isocurve(made, slope).front();
    const auto volume = swept_by(planned.path);
    const SweptVolume& swept = *volume;
    const double tilt = std::sqrt(1 + 1 + 0.25);
    for (const Vec3d p : {a, b, c, d, (a + d) * 0.5, (a + b) * 0.5}) {
        const Vec3d in = p + ((a + c) * 0.5 - p) * 1e-3;
        CHECK((swept.lowest(in.x, in.y).height - in.z) / tilt <= 0.2);
    }
    // All passes are rows: no pass was added for stock left between them.
    CHECK(planned.stats.counts[2].first == "isocurves");
    DOUBLES_EQUAL(planned.stats.passes, planned.stats.counts[2].second, 0);
}

TEST(AdaptiveIsocurve, CutsThePoleOfABowlOnce)
{
    // A curve along the pole followed the rounding of its normals, ten times the length of the
    // bowl.
    Job made = job_for({bowl()}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    made.operations.front().tool.radius = made.operations.front().tool.corner_radius = 3;
    made.operations.front().tolerance.floor = 0.1;
    made.operations.front().tolerance.scallop = 0.2;
    const test::RecordedProgress progress{made};
    const auto planned = plan_adaptive_isocurve(made, made.operations.front());
    // The tip of the tool runs over a ball of radius 2, and once around over the rim.
    CHECK(measure(planned.front().path, {}).cut_length_mm < 130);
    CHECK(swept_by(planned.front().path)->lowest(7.3, -4.1).height < -5.37 + 0.2);
    CHECK(planned.front().stats.scallop_bound_mm <= 0.2);
    DOUBLES_EQUAL(0, planned.front().stats.gouge_bound_mm, 1e-6);
    CHECK(progress.rises(0.3));
}

TEST(AdaptiveIsocurve, KeepsTheScallopBesideARimThatTheBallPassesOutside)
{
    Job bowl = job_for({half_bowl()}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    Operation& finish = bowl.operations.front();
    finish.tool.radius = finish.tool.corner_radius = 3;
    finish.tolerance.scallop = 0.1;
    finish.tolerance.floor = 0.005;
    job::finish_keys(finish).direction = 'v';
    const auto planned = plan_adaptive_isocurve(bowl, finish).front();
    CHECK(planned.stats.scallop_bound_mm <= 0.1);
    // The reach of a ball on the passes' floor beyond the bowl's open side.
    const PartModel model{finish.part.floor};
    Tool lifted = finish.tool;
    lifted.radius += 0.6 * finish.tolerance.floor;
    lifted.corner_radius = lifted.radius;
    const auto volume = swept_by(planned.path);
    const SweptVolume& swept = *volume;
    std::vector<Vec3d> centres;
    for (double y = -2.6; y < -2.2; y += 0.02) {
        if (const auto z = model.drop_height(lifted, 0, y)) {
            centres.push_back({0, y, *z + lifted.radius});
        }
    }
    for (double u = 0.1; u < 0.5; u += 0.05) {
        for (double v = 0.2; v < 0.9; v += 0.05) {
            const SurfacePoint at = model.evaluate(0, u, v);
            double best = 1e9;
            for (const Vec3d& c : centres) {
                const double off = std::hypot(at.point.x - c.x, at.point.y - c.y);
                if (off < 3) {
                    best = std::min(best, c.z - std::sqrt(9 - off * off));
                }
            }
            const double cut = swept.lowest(at.point.x, at.point.y).height;
            CHECK((cut - std::max(best, at.point.z)) * upward_normal(at).z <= 0.1);
        }
    }
}

TEST(AdaptiveIsocurve, KeepsTheScallopOverAGapThatAFloorIsSeenThrough)
{
    Job roof = job_for(open_roof(), cusp::adaptive_isocurve::kAdaptiveIsocurve);
    Operation& finish = roof.operations.front();
    finish.tool.radius = finish.tool.corner_radius = 3;
    finish.tolerance.scallop = 0.1;
    for (const char direction : {'u', 'v'}) {
        job::finish_keys(finish).direction = direction;
        const auto planned = plan_adaptive_isocurve(roof, finish).front();
        CHECK(planned.stats.scallop_bound_mm <= 0.1);
        // A ball on both rims drops between them: it may be no higher than level with them.
        const auto volume = swept_by(planned.path);
        const SweptVolume& swept = *volume;
        for (double y = 0.6; y < 3.5; y += 0.05) {
            CHECK(swept.lowest(5, y).height <= -2.5 + 0.1);
        }
    }
}

TEST(AdaptiveIsocurve, BoundsWhatPassesOfAGivenDistanceLeaveBesideEdges)
{
    // Two walls that meet in an edge below which no isocurve of either ends.
    Job made = job_for({wall(0, -1), wall(1.05, 3)}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    made.operations.front().tolerance.scallop.reset();
    job::finish_keys(made.operations.front()).iso_distance = 0.5;
    const auto planned = plan_adaptive_isocurve(made, made.operations.front());
    CHECK(std::isfinite(planned.front().stats.scallop_bound_mm));
    CHECK(planned.front().stats.scallop_bound_mm < 2);
}

TEST(AdaptiveIsocurve, ProvesWhatPassesOfAGivenDistanceLeaveBetweenThem)
{
    constexpr int kParts = 120;
    for (unsigned seed = 200; seed < 206; ++seed) {
        std::printf("seed %u ", seed);
        std::mt19937 other{seed};
        Job made = job_for({bumps(other, 2)}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
        Operation& at_distance = made.operations.front();
        at_distance.tolerance.scallop.reset();
        job::finish_keys(at_distance).iso_distance = 1.2;
        job::finish_keys(at_distance).even_steps = seed % 3 == 0;
        job::finish_keys(at_distance).direction = seed % 2 == 0 ? 'u' : 'v';
        const Surface& surface = at_distance.part.floor.front();
        const PlannedOperation planned = plan_adaptive_isocurve(made, at_distance).front();
        const double bound = planned.stats.scallop_bound_mm;
        const PartModel model{at_distance.part.floor};
        const auto volume = swept_by(planned.path);
        const SweptVolume& swept = *volume;
        double most = 0;
        for (int i = 0; i <= kParts; ++i) {
            for (int j = 0; j <= kParts; ++j) {
                const SurfacePoint p = derivatives_at(surface, surface.u_end() * i / kParts,
                                                      surface.v_end() * j / kParts);
                const Vec3d n = upward_normal(p);
                const Vec3d tip = p.point + n * 2 - Vec3d{0, 0, 2};
                const double cut = swept.lowest(p.point.x, p.point.y).height;
                if (model.distance(planned.path.tool, tip, 0).distance > -1e-6) {
                    most = std::max(most, (cut - p.point.z) * n.z);
                }
            }
        }
        CHECK(most <= bound);
        CHECK(bound <= 1.35 * most);
    }
}

TEST(AdaptiveIsocurve, NeverEntersRandomSurfaces)
{
    for (unsigned seed = 100; seed < 102; ++seed) {
        std::printf("seed %u ", seed);
        std::mt19937 other{seed};
        operation.part.floor = {bumps(other, 12)};
        job::finish_keys(operation).direction = seed % 2 == 0 ? 'u' : 'v';
        const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
        CHECK(deepest_cut(planned.path, operation.part.floor) <= 1e-6);
    }
}

TEST(AdaptiveIsocurve, IsocurvesAreThoseOfTheApproximatedOffsetToItsBound)
{
    operation.part.floor.pop_back();
    operation.output = OutputForm::kNurbs;
    operation.tolerance.scallop.reset();
    job::finish_keys(operation).iso_distance = 1.0;
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    double exact = 0;
    double bound = 1;
    for (const auto& [name, value] : planned.stats.counts) {
        exact = name == "offset_isocurves" ? value : exact;
        bound = name == "offset_bound_mm" ? value : bound;
    }
    CHECK_EQUAL(planned.stats.passes, static_cast<int>(exact));
    CHECK(bound <= 0.4 * operation.tolerance.floor);
    // The ball is 0.6 tolerances above the surface, within the bound.
    const PartModel model{operation.part.floor};
    for (const ToolMove& move : planned.path.moves) {
        if (const NurbsTo* nurbs = std::get_if<NurbsTo>(&move.shape)) {
            const Curve& curve = nurbs->curve;
            for (int k = 0; k <= 300; ++k) {
                const double u =
                    curve.domain_begin() + (curve.domain_end() - curve.domain_begin()) * k / 300;
                const double apart =
                    model.distance(planned.path.tool, point_at(curve, u), 1).distance;
                DOUBLES_EQUAL(0.6 * operation.tolerance.floor, apart, bound + 1e-6);
            }
        }
    }
}

TEST(AdaptiveIsocurve, WritesOneNurbsForAPassThatNeverEntersTheModel)
{
    operation.part.floor.pop_back();
    operation.output = OutputForm::kNurbs;
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    const MoveCounts moves = measure(planned.path, {}).moves;
    CHECK(moves.nurbs >= planned.stats.passes - 2);
    CHECK(deepest_cut(planned.path, operation.part.floor) <= 1e-6);
}

TEST(AdaptiveIsocurve, CutsNoDeeperThanHalfTheToleranceWhenBothSidesAreAllowed)
{
    operation.tolerance.side = ToleranceSide::kBoth;
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    CHECK(planned.stats.gouge_bound_mm <= 0.01 + 1e-9);
    CHECK(deepest_cut(planned.path, floor) <= planned.stats.gouge_bound_mm + 1e-6);
}

TEST(AdaptiveIsocurve, FewerRetractsThanPassesByStayingDown)
{
    operation.part.floor.pop_back();
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    CHECK(planned.stats.retracts * 10 <= planned.stats.passes);
}

TEST(AdaptiveIsocurve, RetractsAfterEachPassOneWay)
{
    operation.part.floor.pop_back();
    operation.passes.traversal = Traversal::kOneWay;
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    CHECK(planned.stats.retracts >= planned.stats.passes / 2);
}

// Climb milling: stock is to the right of the direction of travel, so each pass is to the right of
// the one before.
TEST(AdaptiveIsocurve, CutsOneWayInTheDirectionAskedFor)
{
    operation.part.floor.pop_back();
    operation.passes.traversal = Traversal::kOneWay;
    for (const CutDirection direction : {CutDirection::kClimb, CutDirection::kConventional}) {
        operation.passes.direction_of_cut = direction;
        for (const char parameter : {'u', 'v'}) {
            job::finish_keys(operation).direction = parameter;
            const std::vector<Vec3d> mids =
                pass_middles(plan_adaptive_isocurve(job, operation).front().path);
            int right = 0;
            for (std::size_t k = 3; k < mids.size(); k += 2) {
                const Vec3d on = mids[k] - mids[k - 2];
                const Vec3d way = mids[k - 1];
                right += way.y * on.x - way.x * on.y > 0 ? 1 : -1;
            }
            CHECK(direction == CutDirection::kClimb ? right > 0 : right < 0);
        }
    }
}

TEST(AdaptiveIsocurve, IsShorterThanParallelPlanesAtTheSameScallop)
{
    operation.part.floor.pop_back();
    const auto isocurves = plan_adaptive_isocurve(job, operation).front();
    const auto planes = plan_parallel_planes(job, operation).front();
    CHECK(measure(isocurves.path, {}).cut_length_mm < measure(planes.path, {}).cut_length_mm);
    CHECK(deepest_cut(planes.path, operation.part.floor) <= 1e-6);
}
