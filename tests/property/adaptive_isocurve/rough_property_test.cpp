// Random models of one to four surfaces, roughed and cut in memory move by move: nothing nearer to
// the model than the allowance, no cut deeper than a level, no metal under rapid moves, nothing
// left that the levels could have taken.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "host_tools/adaptive_isocurve/rough_levels.hpp"
#include "host_tools/surface_offset/surface_model.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"
#include "tests/property/grid_pocket/random_pockets.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"
// it needs the harness before it
#include "CppUTest/MemoryLeakWarningPlugin.h"

namespace cusp::host {
namespace {

Job random_model(Random& random)
{
    Operation operation;
    operation.strategy = "adaptive_isocurve";
    operation.roughing = true;
    operation.tool = random_tool(random);
    operation.tools = {operation.tool};
    double top = -1e300;
    for (int i = whole(random, 1, 4); i > 0; --i) {
        const Box2d box = random_box(random, {20, 15}, 15, 30);
        const double rough = uniform(random, 1.0, 8.0);
        const double middle = uniform(random, -8.0, 0.0);
        operation.floor.push_back(random_floor(random, box, middle, rough));
        for (const Vec3d& p : operation.floor.back().points) {
            top = std::max(top, p.z);
        }
    }
    const double stock_top = top + uniform(random, 0.0, 3.0);
    operation.max_depth = uniform(random, 1.0, 4.0);
    operation.allowance = whole(random, 0, 1) == 0 ? 0.0 : uniform(random, 0.1, 0.6);
    operation.plan_tolerance = 0.02;
    operation.floor_tolerance = 0.02;
    operation.output = whole(random, 0, 1) == 0 ? OutputForm::kLines : OutputForm::kArcs;
    const int entry = whole(random, 0, 2);
    operation.entry = entry == 0   ? EntryKind::kAuto
                      : entry == 1 ? EntryKind::kHelix
                                   : EntryKind::kRamp;
    Job job = job_of(operation);
    job.stock_top = stock_top;
    return job;
}

// The stock as heights over a grid of its own, cut by a tool that stands at places in turn.
class Block {
public:
    Block(const SurfaceModel& model, double top)
        : low_{model.box_low()},
          nx_{static_cast<std::size_t>((model.box_high().x - low_.x) / kPitch) + 1},
          ny_{static_cast<std::size_t>((model.box_high().y - low_.y) / kPitch) + 1},
          height_(nx_ * ny_, top)
    {
    }

    // How much metal the tool meets above its lower side.
    double cut(const Tool& tool, Vec3d tip)
    {
        // Slivers between two places looked at are no metal: they are felt with less of the tool.
        const double less = kStep * kStep / (4 * tool.radius) + 0.004;
        const Tool feeler{tool.number, tool.shape, tool.radius - less,
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
                if (away < feeler.radius) {
                    deepest =
                        std::max(deepest, height - tip.z - less - profile_height(feeler, away));
                }
                if (away <= tool.radius) {
                    height = std::min(height, tip.z + profile_height(tool, away));
                }
            }
        }
        return deepest;
    }

    static constexpr double kPitch = 0.31;
    static constexpr double kStep = 0.15;

private:
    Vec3d low_;
    std::size_t nx_;
    std::size_t ny_;
    std::vector<double> height_;
};

struct Figures {
    double cut{};
    double rapid{};
    double clearance{1e300};
};

Figures figures_of(const PlannedOperation& plan, const SurfaceModel& model, double top)
{
    Figures figures;
    const Tool& tool = plan.path.tool;
    Block block{model, top};
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
                    std::min(figures.clearance, model.clearance(tool, tip, 1.0).distance);
            }
            at = to;
        }
    }
    return figures;
}

void check_model(unsigned seed)
{
    Random random{seed};
    const Job job = random_model(random);
    const Operation& operation = job.operations.front();
    std::printf("random model seed %u: tool radius %.2f corner %.2f, depth %.2f, allowance %.2f\n",
                seed, operation.tool.radius, operation.tool.corner_radius, *operation.max_depth,
                operation.allowance);
    const PlannedOperation plan = plan_rough_levels(job, operation);
    const SurfaceModel model{operation.floor};
    const Figures figures = figures_of(plan, model, job.stock_top);
    std::printf("  cut %.4f rapid %.4f clearance %.5f, %zu moves, %.2f s\n", figures.cut,
                figures.rapid, figures.clearance, plan.path.moves.size(), plan.stats.planning_s);
    CHECK(figures.cut <= *operation.max_depth + 1e-3);
    CHECK(figures.rapid <= 1e-3);
    CHECK(figures.clearance >= operation.allowance - 1e-6);
    CHECK_EQUAL(0.0, plan.stats.gouge_bound_mm);
}

}  // namespace

TEST_GROUP(RoughLevelsProperty){
    // Cells of the model are many: the count of allocations would take all the time.
    void setup() override{MemoryLeakWarningPlugin::turnOffNewDeleteOverloads();
}  // namespace cusp::host
void teardown() override
{
    MemoryLeakWarningPlugin::turnOnDefaultNotThreadSafeNewDeleteOverloads();
}
}
;

TEST(RoughLevelsProperty, RandomModelsKeepTheirAllowanceAndNoCutIsDeeperThanALevel)
{
    const char* const first = std::getenv("CUSP_PROPERTY_FIRST");
    const int begin = first != nullptr ? std::atoi(first) : 1;
    for (int i = 0; i < property_cases(3); ++i) {
        check_model(static_cast<unsigned>(begin + i));
    }
}

}  // namespace cusp::host
