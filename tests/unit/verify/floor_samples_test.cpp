// A ball dropped on points of a dome, compared with the ball on the dome.
#include "host_tools/judge/verify/floor_samples.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::drop_cutter;
using namespace cusp::verify;

namespace {

constexpr double kDome = 10;
constexpr double kBall = 3;
constexpr double kSamplePitch = 0.17;

// Half a ball about the origin; nothing beyond it.
std::vector<double> dome(const HeightGrid& grid)
{
    std::vector<double> heights(grid.size(), std::nan(""));
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            const double x = grid.x(i, j);
            const double y = grid.y(i, j);
            if (x * x + y * y < kDome * kDome) {
                heights[grid.index(i, j)] = std::sqrt(kDome * kDome - x * x - y * y);
            }
        }
    }
    return heights;
}

}  // namespace

TEST_GROUP(FloorSamples){};

TEST(FloorSamples, StopTheBallAtAPointOfTheFloorHardlyLowerThanTheFloorDoes)
{
    const HeightGrid grid{-11, -11, kSamplePitch, 130, 130, true};
    const std::vector<double> heights = dome(grid);
    const FloorSamples samples{grid, heights};
    for (double x = -7.9; x < 8; x += 0.37) {
        const double y = 0.3 * x;
        const LowestPositionSearch::DroppedTool rest = samples.drop_ball(kBall, x, y);
        const double exact = std::sqrt((kDome + kBall) * (kDome + kBall) - x * x - y * y);
        CHECK(rest.centre.z <= exact + 1e-9);
        // The error between points is larger along the axis where the dome is steep.
        const double upright = exact / (kDome + kBall);
        const double apart = kSamplePitch / upright;
        CHECK(rest.centre.z >= exact - apart * apart * (1 / kBall + 1 / kDome) / upright);
        DOUBLES_EQUAL(kBall, norm(rest.centre - rest.contact), 1e-9);
        DOUBLES_EQUAL(kDome, norm(rest.contact), 1e-9);
    }
    CHECK(samples.drop_ball(kBall, 20, 0).centre.z == kInfinite);
}
