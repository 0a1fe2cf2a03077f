#include "host_tools/cam/clearing/clearing.hpp"

#include <algorithm>

#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;
using namespace job;
using namespace offset;

namespace {

Contour rectangle(double x0, double y0, double x1, double y1)
{
    return {line_edge({x0, y0}, {x1, y0}), line_edge({x1, y0}, {x1, y1}),
            line_edge({x1, y1}, {x0, y1}), line_edge({x0, y1}, {x0, y0})};
}

// Largest distance of a point that is at least `wall_clearance` inside the region from every pass.
double widest_gap(const Region2d& region, const ClearedRegion& cleared, double first)
{
    double widest = 0.0;
    for (double x = 0.05; x < 100.0; x += 0.37) {
        for (double y = 0.05; y < 60.0; y += 0.37) {
            if (!contains(region, {x, y}) || distance_to(region, {x, y}) < first) {
                continue;
            }
            double nearest = 1e300;
            for (const ClearingPass& pass : cleared.passes) {
                for (const Edge& edge : pass.path) {
                    nearest = std::min(nearest, distance_to(edge, {x, y}));
                }
            }
            widest = std::max(widest, nearest);
        }
    }
    return widest;
}

Region2d pocket_with_island()
{
    return {{rectangle(0, 0, 100, 60), reversed(rectangle(40, 20, 60, 45))}};
}

TEST_GROUP(Clearing){};

TEST(Clearing, LeavesNoPointFartherThanHalfAStepFromAPass)
{
    ClearingSettings settings;
    settings.wall_clearance = 3.0;
    settings.stepover = 4.0;
    const ClearedRegion cleared = clear_region(pocket_with_island(), settings);
    CHECK(widest_gap(pocket_with_island(), cleared, 3.0) <= 2.0 + 1e-6);
}

TEST(Clearing, EntersOncePerLeafAndIsland)
{
    ClearingSettings settings;
    settings.wall_clearance = 3.0;
    settings.stepover = 4.0;
    const ClearedRegion cleared = clear_region(pocket_with_island(), settings);
    const auto entries =
        std::count_if(cleared.passes.begin(), cleared.passes.end(),
                      [](const ClearingPass& pass) { return pass.start != PassStart::kLink; });
    constexpr int kIslands = 1;
    CHECK(entries <= cleared.leaves + kIslands);
}

TEST(Clearing, RunsClimbCutsWithTheStockOnTheRight)
{
    ClearingSettings settings;
    settings.wall_clearance = 3.0;
    settings.stepover = 4.0;
    for (const CutDirection direction : {CutDirection::kClimb, CutDirection::kConventional}) {
        settings.direction = direction;
        const bool climb = direction == CutDirection::kClimb;
        for (const ClearingPass& pass : clear_region(pocket_with_island(), settings).passes) {
            CHECK_EQUAL(climb != pass.around_island, area(pass.path) > 0.0);
        }
    }
}

TEST(Clearing, IsEmptyWhereTheToolDoesNotFit)
{
    ClearingSettings settings;
    settings.wall_clearance = 31.0;
    settings.stepover = 4.0;
    CHECK(clear_region({{rectangle(0, 0, 100, 60)}}, settings).passes.empty());
}

// The requested step is four times the suitable one, on every level.
TEST(Clearing, DrawsALevelFirstWhereTheLastOneSuited)
{
    ClearingSettings settings;
    settings.wall_clearance = 1.0;
    settings.stepover = 4.0;
    settings.cover_corners = false;
    int looks = 0;
    settings.scallop_share_between = [&looks](const LoopStrip& strip) {
        ++looks;
        const double step = strip.to - strip.from;
        return step * step;
    };
    const ClearedRegion cleared = clear_region({{rectangle(0, 0, 22, 22)}}, settings);
    CHECK(cleared.rings >= 9);
    CHECK(looks <= cleared.rings + 4);
    CHECK(cleared.widest_gap <= 1.0);
    CHECK(cleared.widest_gap >= 0.98);
}

}  // namespace
}  // namespace cusp::test
