// The tip lowest at a single place, with no line from it.
#include "host_tools/cam/contour_pocket/pencil_curves.hpp"

#include <algorithm>
#include <cstdio>
#include <random>

#include "tests/support/holed_sheet.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace drop_cutter;
using namespace nurbs;
using namespace toolpath;

namespace {

TEST_GROUP(PencilCurves){};

// Over holes narrower than the ball, for any position of the search's grid.
TEST(PencilCurves, ALineCrossesTheBottomOfADimple)
{
    constexpr unsigned kSeed = 5;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> share{0, 1};
    for (int turn = 0; turn < 40; ++turn) {
        const double hole = 0.02 + 0.02 * share(random);  // of 30 mm
        const double radius = 30 * hole * (1.3 + share(random));
        std::vector<Surface> surfaces = holed_floor(hole);
        for (Vec3d& p : surfaces[1].points) {
            p.z = 5 + 0.1 * (p.z - 4.5);  // rims that are all but level are met at one place
        }
        const DropCutter floor{surfaces, {1, ToolShape::kBall, radius, radius}, 1e-4};
        PencilSearch search;
        const double shift = 0.2 * radius * share(random);
        search.box = {11 + shift, 11 + shift, 19 + shift, 19 + shift};
        search.inside = [](Vec2d) {
            return true;
        };
        search.jump = 0.02;
        search.fine = 1e-3;
        double bottom = 1e300;
        constexpr double kPitch = 0.02;
        for (double x = 14; x < 16; x += kPitch) {
            for (double y = 14; y < 16; y += kPitch) {
                bottom = std::min(bottom, floor.tip_height({x, y}));
            }
        }
        double lowest = 1e300;
        for (const PencilCurve& line : pencil_curves(floor, search)) {
            for (const PencilPoint& point : line.points) {
                lowest = std::min(lowest, floor.tip_height(point.at));
            }
        }
        CHECK(lowest < bottom + 1e-3);
    }
}

}  // namespace
}  // namespace cusp::test
