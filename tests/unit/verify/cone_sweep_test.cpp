// The cut of cones along sloped moves, against the lowest of many positions.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "tests/support/leaks_on_threads.hpp"

using namespace cusp;
using namespace cusp::verify;
using toolpath::Tool;
using toolpath::ToolShape;

TEST_GROUP(ConeSweep){};

TEST(ConeSweep, APointIsCutAsLowAsAnyPositionOfTheMoveCutsIt)
{
    constexpr unsigned kSeed = 52;
    constexpr int kCases = 24;
    constexpr int kPositions = 1000;
    std::printf("cones on slopes: seed %u, %d cases\n", kSeed, kCases);
    std::mt19937 engine{kSeed};
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(engine);
    };
    const HeightGrid grid{-2.0, -2.0, 0.1, 41, 41, true};
    double deepest = 0;
    for (int n = 0; n < kCases; ++n) {
        Tool tool;
        tool.shape = ToolShape::kVee;
        tool.radius = uniform(0.8, 1.5);
        tool.tip_angle = uniform(0.3, 2.2);
        tool.tip_radius = n % 3 == 1 ? uniform(0.05, 0.4) : 0.0;
        if (n % 3 == 2) {
            tool.shape = ToolShape::kTaper;
            tool.corner_radius = uniform(0.1, 0.5);
        }
        const Vec3d a{uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-2, -1)};
        const Vec3d b{uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-2, -1)};
        MachinedStock stock{grid, 5};
        stock.cut({tool, {a, b}, {false, false}}, 1.0, [](double) {});
        const double steep = std::abs(b.z - a.z) / kPositions;
        for (std::size_t k = 0; k < grid.size(); ++k) {
            const Vec2d p{grid.x(k / grid.ny, k % grid.ny), grid.y(k / grid.ny, k % grid.ny)};
            double lowest = 5;
            double at_rim = 5;  // a position between two of these may reach a point that they miss
            for (int i = 0; i <= kPositions; ++i) {
                const Vec3d tip = a + (b - a) * (i / static_cast<double>(kPositions));
                const double away = norm(p - in_plan(tip));
                lowest = std::min(lowest, tip.z + profile_height(tool, away));
                if (away < tool.radius + 0.002) {
                    at_rim =
                        std::min(at_rim, tip.z + profile_height(tool, std::min(away, tool.radius)));
                }
            }
            CHECK(stock.heights()[k] <= lowest + 1e-9);
            CHECK(stock.heights()[k] >= std::min(lowest, at_rim) - steep - 1e-3);
            deepest = std::max(deepest, 5 - stock.heights()[k]);
        }
    }
    CHECK(deepest > 6);
}
