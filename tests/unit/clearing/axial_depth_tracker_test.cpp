// Depths of straight cuts of a ball, and the heights that a limit allows, against closed forms.
#include "host_tools/cam/clearing/axial_depth_tracker.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::clearing;
using namespace cusp::toolpath;

namespace {

constexpr Tool kBall{1, ToolShape::kBall, 3, 3};

ToolMove cut_to(Vec3d end) { return {MoveKind::kCut, LineTo{end}}; }

}  // namespace

TEST_GROUP(AxialDepthTracker){};

TEST(AxialDepthTracker, KnowsTheDeepestCutAndTheStockThatIsLeft)
{
    AxialDepthTracker depth{{-10, -10, 10, 10}, kBall, 0.0, std::nullopt};
    std::vector<ToolMove> path{cut_to({-8, 0, -2})};
    depth.track(path);
    DOUBLES_EQUAL(0.0, depth.deepest(), 0.0);  // where a path comes from is over the stock
    path.push_back(cut_to({8, 0, -2}));
    depth.track(path);
    DOUBLES_EQUAL(2.0, depth.deepest(), 0.05);
    DOUBLES_EQUAL(-2.0, depth.stock_top_at({0, 0}), 0.05);
    // The rim of the ball still meets the top beside its groove.
    CHECK(depth.stock_top_around({0, 0}, 2.0) > -0.5);
    CHECK(!depth.allowed_height_over({-8, 0, -9}, {cut_to({8, 0, -9})}, 1.0));
}

TEST(AxialDepthTracker, MovesThatAreTooDeepMayBeRaisedToTheLimit)
{
    AxialDepthTracker depth{{-10, -10, 10, 10}, kBall, 0.0, 1.0};
    const auto height = depth.allowed_height_over({-8, 0, -2}, {cut_to({8, 0, -2})}, 1.0);
    CHECK(height.has_value());
    DOUBLES_EQUAL(-0.9, height.value_or(0.0), 0.05);
    CHECK(!depth.allowed_height_over({-8, 0, -0.9}, {cut_to({8, 0, -0.9})}, 1.0));
    // Looking ahead cuts nothing.
    DOUBLES_EQUAL(0.0, depth.stock_top_at({0, 0}), 0.05);
}
