// Random models of one to four surfaces, roughed and cut in memory move by move: nothing nearer to
// the model than the allowance, no cut deeper than a level, no stock under rapid moves, nothing
// left that the levels could have removed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_roughing.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/random_pockets.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"
// it needs the harness before it
#include "CppUTest/MemoryLeakWarningPlugin.h"

namespace cusp::test {

using namespace adaptive_isocurve;
using namespace job;
using namespace offset;
using namespace part_model;
using namespace toolpath;

namespace {

Job random_model(Random& random, unsigned seed)
{
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.passes.roughing = true;
    operation.tool = random_tool(random);
    operation.tools = {operation.tool};
    if (seed % 2 == 0) {
        for (int i = whole(random, 1, 2); i > 0; --i) {
            Tool smaller = random_tool(random);
            const double share = uniform(random, 0.3, 0.8);
            smaller.number = 1 + static_cast<int>(operation.tools.size());
            smaller.radius = share * operation.tools.back().radius;
            smaller.corner_radius = smaller.shape == ToolShape::kFlat   ? 0.0
                                    : smaller.shape == ToolShape::kBall ? smaller.radius
                                                                        : 0.4 * smaller.radius;
            operation.tools.push_back(smaller);
        }
        std::shuffle(operation.tools.begin(), operation.tools.end(), random);
    }
    double top = -1e300;
    for (int i = whole(random, 1, 4); i > 0; --i) {
        const Box2d box = random_box(random, {20, 15}, 15, 30);
        const double rough = uniform(random, 1.0, 8.0);
        const double middle = uniform(random, -8.0, 0.0);
        operation.part.floor.push_back(random_floor(random, box, middle, rough));
        for (const Vec3d& p : operation.part.floor.back().points) {
            top = std::max(top, p.z);
        }
    }
    const double stock_top = top + uniform(random, 0.0, 3.0);
    operation.levels.max_depth = uniform(random, 1.0, 4.0);
    if (seed % 3 == 0) {
        operation.levels.min_depth = uniform(random, 0.2, 1.0) * *operation.levels.max_depth;
    }
    operation.passes.allowance = whole(random, 0, 1) == 0 ? 0.0 : uniform(random, 0.1, 0.6);
    operation.tolerance.plan = 0.02;
    operation.tolerance.floor = 0.02;
    operation.output = whole(random, 0, 1) == 0 ? OutputForm::kLines : OutputForm::kArcs;
    const int entry = whole(random, 0, 2);
    operation.passes.entry = entry == 0   ? EntryKind::kAuto
                             : entry == 1 ? EntryKind::kHelix
                                          : EntryKind::kRamp;
    Job job = job_of(operation);
    job.stock_top = stock_top;
    return job;
}

// The stock as heights on a grid of its own, cut by a tool at discrete positions.
class Block {
public:
    Block(const PartModel& model, double top)
        : low_{model.box_low()},
          nx_{static_cast<std::size_t>((model.box_high().x - low_.x) / kPitch) + 1},
          ny_{static_cast<std::size_t>((model.box_high().y - low_.y) / kPitch) + 1},
          height_(nx_ * ny_, top)
    {
    }

    // Depth of the stock above the tool's lower side, mm.
    double cut(const Tool& tool, Vec3d tip)
    {
        // Slivers between two positions do not count: the depth is probed with a smaller tool.
        const double less = kStep * kStep / (4 * tool.radius) + 0.004;
        const Tool probe{tool.number, tool.shape, tool.radius - less,
                         std::max(0.0, tool.corner_radius - less)};
        double deepest = 0;
        const auto range = [&](double at, double first, std::size_t count) {
            const double begin = std::ceil((at - tool.radius - first) / kPitch);
            const double end = std::floor((at + tool.radius - first) / kPitch) + 1;
            const auto clamped = [&](double value) {
                return static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(count)));
            };
            return std::pair{clamped(begin), clamped(end)};
        };
        const auto [i0, i1] = range(tip.x, low_.x, nx_);
        const auto [j0, j1] = range(tip.y, low_.y, ny_);
        for (std::size_t i = i0; i < i1; ++i) {
            for (std::size_t j = j0; j < j1; ++j) {
                const double away = std::hypot(low_.x + static_cast<double>(i) * kPitch - tip.x,
                                               low_.y + static_cast<double>(j) * kPitch - tip.y);
                double& height = height_[i * ny_ + j];
                if (away < probe.radius) {
                    deepest =
                        std::max(deepest, height - tip.z - less - profile_height(probe, away));
                }
                if (away <= tool.radius) {
                    height = std::min(height, tip.z + profile_height(tool, away));
                }
            }
        }
        return deepest;
    }

    // The highest stock left above a level where the tool would fit with room to spare.
    double left(const PartModel& model,
                const Tool& tool,
                const std::set<double>& levels,
                double room) const
    {
        double most = 0;
        for (std::size_t i = 0; i < nx_; i += 3) {
            for (std::size_t j = 0; j < ny_; j += 3) {
                const Vec3d at{low_.x + static_cast<double>(i) * kPitch,
                               low_.y + static_cast<double>(j) * kPitch, 0};
                for (const double z : levels) {
                    if (height_[i * ny_ + j] - z <= most) {
                        break;
                    }
                    if (model.distance(tool, {at.x, at.y, z}, room).distance >= room) {
                        most = height_[i * ny_ + j] - z;
                    }
                }
            }
        }
        return most;
    }

    static constexpr double kPitch = 0.31;
    static constexpr double kStep = 0.15;

private:
    Vec3d low_;
    std::size_t nx_;
    std::size_t ny_;
    std::vector<double> height_;
};

constexpr double kEnough = 0.05;  // mm over the allowance

struct Figures {
    double cut{};
    double rapid{};
    double clearance{1e300};
    std::set<double> levels;
};

// Distances from the model matter below `enough`.
void cut(Block& block,
         const PlannedOperation& plan,
         const PartModel& model,
         double enough,
         Figures& figures)
{
    const Tool& tool = plan.path.tool;
    Vec3d at = end_of(plan.path.moves.front());
    for (std::size_t k = 1; k < plan.path.moves.size(); ++k) {
        const ToolMove& move = plan.path.moves[k];
        for (const Vec3d& to : points_of(move, at, 1e-3)) {
            const int parts = 1 + static_cast<int>(norm(to - at) / Block::kStep);
            for (int i = 1; i <= parts; ++i) {
                const Vec3d tip = at + (to - at) * (static_cast<double>(i) / parts);
                double& deepest = move.kind == MoveKind::kRapid ? figures.rapid : figures.cut;
                deepest = std::max(deepest, block.cut(tool, tip));
                figures.clearance =
                    std::min(figures.clearance, model.distance(tool, tip, enough).distance);
            }
            at = to;
        }
        if (move.kind == MoveKind::kCut) {
            figures.levels.insert(at.z);
        }
    }
}

// The least distance of neighbours, the stock's top included.
double thinnest_level(const std::set<double>& levels, double top)
{
    double least = 1e300;
    double above = top;
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
        least = std::min(least, above - *level);
        above = *level;
    }
    return least;
}

const Tool& smallest(const Operation& operation)
{
    return *std::min_element(operation.tools.begin(), operation.tools.end(),
                             [](const Tool& a, const Tool& b) { return a.radius < b.radius; });
}

void check_model(unsigned seed)
{
    Random random{seed};
    const Job job = random_model(random, seed);
    const Operation& operation = job.operations.front();
    std::printf("random model seed %u: depth %.2f, at least %.2f, allowance %.2f, tools", seed,
                *operation.levels.max_depth, operation.levels.min_depth.value_or(0),
                operation.passes.allowance);
    for (const Tool& tool : operation.tools) {
        std::printf(" R%.2f/%.2f", tool.radius, tool.corner_radius);
    }
    const std::vector<PlannedOperation> plans = plan_waterline_roughing(job, operation);
    const PartModel model{operation.part.floor};
    Block block{model, job.stock_top};
    Figures figures;
    std::size_t moves = 0;
    double seconds = 0;
    double gouge = 0;
    std::size_t warnings = 0;
    for (const PlannedOperation& plan : plans) {
        cut(block, plan, model, operation.passes.allowance + kEnough, figures);
        moves += plan.path.moves.size();
        seconds += plan.stats.planning_s;
        gouge = std::max(gouge, plan.stats.gouge_bound_mm);
        warnings += plan.stats.warnings.size();
        std::printf("; tool %d %d loops %d retracts", plan.path.tool.number, plan.stats.passes,
                    plan.stats.retracts);
    }
    const double left =
        block.left(model, smallest(operation), figures.levels, operation.passes.allowance + 0.3);
    const double thinnest = thinnest_level(figures.levels, job.stock_top);
    std::printf(
        "\n  cut %.4f rapid %.4f clearance %.5f left %.4f, %zu levels from %.3f, %zu "
        "moves, %.2f s\n",
        figures.cut, figures.rapid, figures.clearance, left, figures.levels.size(), thinnest, moves,
        seconds);
    CHECK(figures.cut <= *operation.levels.max_depth + 1e-3);
    CHECK(figures.rapid <= 1e-3);
    CHECK(figures.clearance >= operation.passes.allowance - 1e-6);
    CHECK(left <= 0.3 * *operation.levels.max_depth);
    // Fewer levels would be deeper than max_depth, or a warning says so.
    CHECK(thinnest >= operation.levels.min_depth.value_or(0) - 2e-3 || warnings > 0);
    CHECK_EQUAL(0.0, gouge);
}

}  // namespace

TEST_GROUP(WaterlineRoughingProperty){
    // Cells of the model are many: the count of allocations would take all the time.
    void setup() override{MemoryLeakWarningPlugin::turnOffNewDeleteOverloads();
}  // namespace cusp::test
void teardown() override { MemoryLeakWarningPlugin::turnOffNewDeleteOverloads(); }
}
;

TEST(WaterlineRoughingProperty, RandomModelsKeepTheirAllowanceAndNoCutIsDeeperThanALevel)
{
    const char* const first = std::getenv("CUSP_PROPERTY_FIRST");
    const int begin = first != nullptr ? std::atoi(first) : 1;
    for (int i = 0; i < property_cases(3); ++i) {
        check_model(static_cast<unsigned>(begin + i));
    }
}

}  // namespace cusp::test
