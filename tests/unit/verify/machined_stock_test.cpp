// Random ways of tools with round corners, one after the other, against every point held against every position.
#include "host_tools/judge/verify/machined_stock.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/nurbs/plan_vector.hpp"
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
        Tool tool;
        tool.shape = n_ % 2 == 0 ? ToolShape::kBall : ToolShape::kBull;
        tool.radius = uniform(0.5, 2.5);
        tool.corner_radius = n_++ % 2 == 0 ? tool.radius : tool.radius * uniform(0.3, 0.9);
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
        stock_.cut(way, kSpacing, [](double) {});
        for (const Vec3d tip : way.tips) {
            cut_plainly(tool, tip);
        }
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

    void cut_plainly(const Tool& tool, Vec3d tip)
    {
        for (std::size_t k = 0; k < grid_.size() && tip.z < kTop; ++k) {
            const Vec2d p{grid_.x(k / grid_.ny, k % grid_.ny), grid_.y(k / grid_.ny, k % grid_.ny)};
            const double away = norm(p - in_plan(tip));
            if (away <= tool.radius) {
                plain_[k] = std::min(plain_[k], tip.z + profile_height(tool, away));
            }
        }
    }

    std::mt19937 engine_;
    MachinedStock stock_;
    HeightGrid grid_;
    std::vector<double> plain_;
    int n_{0};
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
        for (int n = 0; n < 12; ++n) {
            cuts.cut();
        }
        DOUBLES_EQUAL(0, cuts.farthest_from_plain(), 1e-9);
    }
}
