// Random ways of tools, one after the other, against every point held against every position, and against the sweep of
// a flat bottom between them.
#include "host_tools/judge/verify/machined_stock.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/judge/verify/end_sweeps.hpp"
#include "tests/support/leaks_on_threads.hpp"

using namespace cusp;
using namespace cusp::verify;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kTop = 2;
constexpr double kSpacing = 0.1;

class RandomCuts {
public:
    RandomCuts(unsigned seed, const HeightGrid& grid)
        : engine_{seed}, stock_{grid, kTop}, grid_{grid}, plain_(grid.size(), kTop)
    {
    }

    // A rapid, then feed moves; down, up and level.
    void cut()
    {
        constexpr std::array kShapes{ToolShape::kBall, ToolShape::kBull, ToolShape::kFlat};
        Tool tool;
        tool.shape = kShapes[n_++ % kShapes.size()];
        tool.radius = uniform(0.5, 2.5);
        tool.corner_radius = tool.shape == ToolShape::kBall   ? tool.radius
                             : tool.shape == ToolShape::kBull ? tool.radius * uniform(0.3, 0.9)
                                                              : 0.0;
        ToolPositions way{tool, {}, {}};
        Vec3d at{uniform(0, 8), uniform(0, 5), uniform(-1, 2.2)};
        for (int move = 0; move < 4; ++move) {
            const Vec3d to{uniform(0, 8), uniform(0, 5),
                           uniform(0, 1) < 0.5 ? at.z : uniform(-1, 2.2)};
            const int steps = 1 + static_cast<int>(norm(to - at) / kSpacing);
            for (int i = 1; i <= steps; ++i) {
                way.tips.push_back(at + (to - at) * (i / static_cast<double>(steps)));
                way.rapid.push_back(move == 0);
            }
            at = to;
        }
        const double depth = stock_.cut(way, kSpacing, [](double) {});
        double plain_depth = 0;
        for (std::size_t k = 0; k < way.tips.size(); ++k) {
            const double cut = cut_plainly(tool, way.tips[k]);
            plain_depth = way.rapid[k] ? plain_depth : std::max(plain_depth, cut);
            if (tool.shape == ToolShape::kFlat && k > 0 && way.tips[k - 1].z < kTop) {
                sweep_plainly(tool, way.tips[k - 1], way.tips[k]);
            }
        }
        DOUBLES_EQUAL(plain_depth, depth, 1e-9);
    }

    double farthest_from_plain() const
    {
        double farthest = 0;
        for (std::size_t k = 0; k < grid_.size(); ++k) {
            farthest = std::max(farthest, std::abs(stock_.heights()[k] - plain_[k]));
        }
        return farthest;
    }

private:
    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(engine_);
    }

    // Returns how deep a tool reduced by the height of slivers, and raised by as much, was in stock.
    double cut_plainly(const Tool& tool, Vec3d tip)
    {
        const double shrink = kSpacing * kSpacing / (4 * tool.radius) + 0.002;
        Tool probe = tool;
        probe.radius -= shrink;
        probe.corner_radius = std::max(0.0, tool.corner_radius - shrink);
        double depth = 0;
        for (std::size_t k = 0; k < grid_.size() && tip.z < kTop; ++k) {
            const double away = norm(point(k) - in_plan(tip));
            if (away <= probe.radius) {
                depth = std::max(depth, plain_[k] - tip.z - shrink - profile_height(probe, away));
            }
            if (away <= tool.radius) {
                plain_[k] = std::min(plain_[k], tip.z + profile_height(tool, away));
            }
        }
        return depth;
    }

    void sweep_plainly(const Tool& tool, Vec3d from, Vec3d to)
    {
        const FlatSweep sweep{from, to, tool.radius};
        for (std::size_t k = 0; k < grid_.size() && to.z < kTop; ++k) {
            plain_[k] = std::min(plain_[k], sweep.lowest(point(k).x, point(k).y));
        }
    }

    Vec2d point(std::size_t k) const
    {
        return {grid_.x(k / grid_.ny, k % grid_.ny), grid_.y(k / grid_.ny, k % grid_.ny)};
    }

    std::mt19937 engine_;
    MachinedStock stock_;
    HeightGrid grid_;
    std::vector<double> plain_;
    std::size_t n_{0};
};

}  // namespace

TEST_GROUP(MachinedStock){};

TEST(MachinedStock, IsAsLowAsAnyPositionCutsIt)
{
    constexpr unsigned kSeed = 57;
    std::printf("ways through stock: seed %u\n", kSeed);
    // Rows that are compared together are 16: whole runs, less than one, and some beyond.
    for (const std::size_t rows : {std::size_t{64}, std::size_t{11}, std::size_t{50}}) {
        RandomCuts cuts{kSeed, {-0.5, -0.5, 0.11, 80, rows, rows != 11}};
        for (int n = 0; n < 18; ++n) {
            cuts.cut();
        }
        DOUBLES_EQUAL(0, cuts.farthest_from_plain(), 1e-9);
    }
}
