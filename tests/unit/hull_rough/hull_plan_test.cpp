// Whole plans, judged by a height map that is cut move by move.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tap.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp::hull_rough;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::test;
using namespace cusp::toolpath;
using cusp::Vec3d;

namespace {

Operation tap_operation(int extra_subdivision)
{
    Operation operation;
    operation.strategy = &cusp::hull_rough::kHullRough;
    operation.part.floor = {tap()};
    operation.tool = {1, ToolShape::kFlat, 6, 0};
    operation.levels.max_depth = 2;
    operation.levels.min_depth = 1;
    operation.tolerance.plan = 0.02;
    cusp::hull_rough::hull_keys(operation).extra_subdivision = extra_subdivision;
    return operation;
}

// Stock over the tap as heights on a raster, and the surface under it as points.
class Block {
public:
    Block() : heights_(kColumns * kRows, 18.6667)
    {
        const Surface surface = tap();
        for (int i = 0; i <= 300; ++i) {
            for (int j = 0; j <= 120; ++j) {
                points_.push_back(point_at(surface, i / 300.0, j / 120.0));
            }
        }
    }

    // Cuts with a flat tool along a move. Depth is measured with a slightly smaller tool: slivers
    // between sampled places are no stock.
    void cut(const Tool& tool, MoveKind kind, Vec3d a, Vec3d b)
    {
        const int steps = static_cast<int>(std::ceil(std::hypot(b.x - a.x, b.y - a.y) / 0.4)) + 1;
        for (int k = 0; k <= steps; ++k) {
            const Vec3d tip = a + (b - a) * (static_cast<double>(k) / steps);
            if (tip.z < 18.7) {
                cut_at(tool, kind, tip);
            }
        }
    }

    double volume() const
    {
        double sum = 0;
        for (const double h : heights_) {
            sum += h * kCell * kCell;
        }
        return sum;
    }

    // Depth of a gouge by a tip at `z` over any sampled surface point.
    double deepest_gouge(const Tool& tool, Vec3d tip) const
    {
        double deepest = 0;
        for (const Vec3d& p : points_) {
            if (std::hypot(p.x - tip.x, p.y - tip.y) < tool.radius) {
                deepest = std::max(deepest, p.z - tip.z);
            }
        }
        return deepest;
    }

    double deepest_cut{};
    double deepest_rapid{};

private:
    static constexpr double kCell = 0.6;
    static constexpr int kColumns = 195;
    static constexpr int kRows = 80;
    std::vector<double> heights_;
    std::vector<Vec3d> points_;

    void cut_at(const Tool& tool, MoveKind kind, Vec3d tip)
    {
        const int reach = static_cast<int>(tool.radius / kCell) + 1;
        const int column = static_cast<int>(tip.x / kCell);
        const int row = static_cast<int>((tip.y + 24) / kCell);
        for (int i = std::max(0, column - reach); i < std::min(kColumns, column + reach + 1); ++i) {
            for (int j = std::max(0, row - reach); j < std::min(kRows, row + reach + 1); ++j) {
                const double d =
                    std::hypot((i + 0.5) * kCell - tip.x, (j + 0.5) * kCell - 24 - tip.y);
                double& h = heights_[static_cast<std::size_t>(i * kRows + j)];
                if (d < tool.radius - 0.01) {
                    double& deepest = kind == MoveKind::kRapid ? deepest_rapid : deepest_cut;
                    deepest = std::max(deepest, h - tip.z);
                }
                h = d < tool.radius ? std::min(h, tip.z) : h;
            }
        }
    }
};

Vec3d end_of(const ToolMove& move)
{
    if (const auto* arc = std::get_if<ArcTo>(&move.shape)) {
        return arc->end;
    }
    return std::get<LineTo>(move.shape).end;
}

void machine(Block& block, const std::vector<PlannedOperation>& plan)
{
    for (const PlannedOperation& operation : plan) {
        Vec3d at = end_of(operation.path.moves.front());
        for (const ToolMove& move : operation.path.moves) {
            const Vec3d end = end_of(move);
            block.cut(operation.path.tool, move.kind, at, end);
            at = end;
        }
    }
}

constexpr double kStockVolume = 104832;
constexpr double kPartVolume = 22604;

}  // namespace

TEST_GROUP(HullPlan){};

TEST(HullPlan, OfTheTapHasThePapersLayersAndCutsNoDeeper)
{
    const auto plan = plan_hull_rough(plain_job(), tap_operation(0));
    LONGS_EQUAL(1, plan.size());
    DOUBLES_EQUAL(15, count_of(plan[0], "layers"), 0);
    Block block;
    machine(block, plan);
    CHECK(block.deepest_cut < 1.84);
    CHECK(block.deepest_rapid <= 0);
}

TEST(HullPlan, NeverReachesIntoTheSurface)
{
    for (const int levels : {0, 2}) {
        const auto plan = plan_hull_rough(plain_job(), tap_operation(levels));
        const Block block;
        for (std::size_t i = 0; i < plan[0].path.moves.size(); i += 7) {
            const ToolMove& move = plan[0].path.moves[i];
            DOUBLES_EQUAL(0, block.deepest_gouge(plan[0].path.tool, end_of(move)), 0);
        }
    }
}

TEST(HullPlan, WithExtraSubdivisionTakesNinetyFivePercentInNoMoreThanSeventeenLayers)
{
    const auto plan = plan_hull_rough(plain_job(), tap_operation(3));
    CHECK(count_of(plan[0], "layers") <= 17);
    Block block;
    machine(block, plan);
    const double removed = kStockVolume - block.volume();
    CHECK(removed >= 0.95 * (kStockVolume - kPartVolume));
    CHECK(block.deepest_cut < 2.01);
}

TEST(HullPlan, KeepsTheDepthWhenASmallCutterFollowsALargeOne)
{
    Operation operation = tap_operation(2);
    operation.tools = {{1, ToolShape::kFlat, 10, 0}, {2, ToolShape::kFlat, 2, 0}};
    Job job = plain_job();
    job.feed = 100;
    const auto plan = plan_hull_rough(job, operation);
    Block block;
    machine(block, plan);
    CHECK(block.deepest_cut < 2.01);
    CHECK(block.deepest_rapid <= 0);
}

TEST(HullPlan, RefusesInputThatCannotBeUsedWithItsValueAndLimit)
{
    const double nothing = std::nan("");
    const auto says = [](const char* part, auto change) {
        Operation operation = tap_operation(0);
        change(operation);
        const std::string text =
            cusp::test::refusal([&] { plan_hull_rough(plain_job(), operation); });
        STRCMP_CONTAINS(part, text.c_str());
    };
    says("floor names no surface", [](Operation& o) { o.part.floor.clear(); });
    says("max_depth 0.0 mm must be above 0", [](Operation& o) { o.levels.max_depth = 0.0; });
    says("max_depth nan mm must be above 0", [&](Operation& o) { o.levels.max_depth = nothing; });
    says("min_depth 3.0 mm lies outside 0 to max_depth 2.0 mm",
         [](Operation& o) { o.levels.min_depth = 3.0; });
    says("min_depth nan", [&](Operation& o) { o.levels.min_depth = nothing; });
    says("makes more than 10000 layers of a stock 18.66", [](Operation& o) {
        o.levels.max_depth = 1e-5;
        o.levels.min_depth = 0.0;
    });
    says("overlap 12.0 mm lies outside 0 to the diameter 12.0 mm of tool 1",
         [](Operation& o) { cusp::hull_rough::hull_keys(o).overlap = 12; });
    says("overlap -1.0 mm", [](Operation& o) { cusp::hull_rough::hull_keys(o).overlap = -1; });
    says("overlap nan", [&](Operation& o) { cusp::hull_rough::hull_keys(o).overlap = nothing; });
    says("allowance or tolerance -0.5 mm must be at least 0",
         [](Operation& o) { o.passes.allowance = -0.5; });
    says("extra_subdivision 9 lies outside 0 to 8",
         [](Operation& o) { cusp::hull_rough::hull_keys(o).extra_subdivision = 9; });
    says("output \"nurbs\"", [](Operation& o) { o.output = OutputForm::kNurbs; });
    says("layers: depth 2.0 mm is not below the one before", [](Operation& o) {
        o.levels.layers = {2, 1};
    });
    says("bottom at z 0.0 mm", [](Operation& o) { o.levels.layers = {2, 100}; });
    says("tool 1 has radius 0.0 mm", [](Operation& o) { o.tool.radius = 0; });
    says("max_depth 1e-05 mm makes more", [](Operation& o) {
        o.levels.max_depth = 1e-5;
        o.levels.min_depth = 0.0;
    });
    says("boundary and islands are not used", [](Operation& o) {
        o.outline.boundary = loop_of({{0, 0}, {9, 0}, {9, 9}});
    });
    says("max_depth inf mm must be above 0",
         [](Operation& o) { o.levels.max_depth = std::numeric_limits<double>::infinity(); });
    says("leave nothing of it", [](Operation& o) {
        o.part.floor.front().trims = {loop_of({{2, 2}, {3, 2}, {3, 3}, {2, 3}})};
    });
}

TEST(HullPlan, WhereNothingIsToBeRoughedItSaysWhyAndHasNoMoves)
{
    const auto says = [](const char* part, const std::function<void(Operation&)>& change) {
        Operation operation = tap_operation(0);
        change(operation);
        const auto planned = plan_hull_rough(plain_job(), operation);
        CHECK_EQUAL(1U, planned.size());
        CHECK(planned.front().path.moves.empty());
        STRCMP_CONTAINS(part, planned.front().stats.warnings.front().c_str());
    };
    says("the smallest has radius 6.0 mm, with an allowance of 100.0 mm",
         [](Operation& o) { o.passes.allowance = 100; });
    says("the part is flat: its hull is 0.0 mm high", [](Operation& o) {
        for (Vec3d& p : o.part.floor.front().points) {
            p.z = 0;
        }
    });
}
