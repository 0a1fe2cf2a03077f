// Engraving below random floors, judged at dense places by an exact drop on the surfaces, and that by sampled points.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/drop_cutter/surface_bounds.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/draw.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/tap.hpp"
#include "tests/support/test_jobs.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace prismatic;
using job::Job;
using job::Operation;
using job::Prismatic;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kDepth = 0.4;  // mm
constexpr double kSide = 30;    // mm: floors are squares

nurbs::Surface random_sheet(Draw& draw, double height)
{
    const int count = draw.whole(4, 8);
    const double step = kSide / (count - 3);
    const double tilt_x = draw.uniform(-0.4, 0.4);
    const double tilt_y = draw.uniform(-0.4, 0.4);
    std::vector<Vec3d> net;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const double x = (i - 1) * step;
            const double y = (j - 1) * step;
            net.push_back({x, y, tilt_x * x + tilt_y * y + draw.uniform(-height, height)});
        }
    }
    nurbs::Surface sheet = bicubic(count, count, std::move(net));
    if (draw.whole(0, 3) == 0) {
        for (double& weight : sheet.weights) {
            weight = draw.uniform(0.7, 1.4);
        }
    }
    return sheet;
}

// One smooth sheet, or two that cut through each other in creases.
std::vector<nurbs::Surface> random_floor(Draw& draw)
{
    const double height = draw.uniform(0, 4);
    std::vector<nurbs::Surface> floor{random_sheet(draw, height)};
    if (draw.whole(0, 2) == 0) {
        floor.push_back(random_sheet(draw, height));
    }
    return floor;
}

Tool random_tool(Draw& draw)
{
    Tool tool;
    tool.shape = ToolShape::kVee;
    tool.radius = 3;
    tool.tip_angle = draw.uniform(0.3, 1.8);
    const int kind = draw.whole(0, 3);
    if (kind == 1) {
        tool.tip_radius = draw.uniform(0.05, 0.4);
    } else if (kind == 2) {
        tool.shape = ToolShape::kTaper;
        tool.corner_radius = draw.uniform(0.2, 1);
    } else if (kind == 3) {
        tool = Tool{};
        tool.shape = ToolShape::kBall;
        tool.radius = tool.corner_radius = draw.uniform(0.5, 2);
    }
    return tool;
}

// An open polyline well inside the floor.
job::Chain random_curve(Draw& draw)
{
    std::vector<Vec2d> corners;
    const int count = draw.whole(2, 4);
    for (int k = 0; k < count; ++k) {
        corners.push_back({draw.uniform(4, kSide - 4), draw.uniform(4, kSide - 4)});
    }
    job::Chain chain;
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
        nurbs::Curve line;
        line.degree = 1;
        line.knots = {0, 0, 1, 1};
        line.points = {{corners[k].x, corners[k].y, 0}, {corners[k + 1].x, corners[k + 1].y, 0}};
        line.weights = {1, 1};
        chain.push_back(line);
    }
    return chain;
}

Operation random_engraving(Draw& draw)
{
    Operation operation;
    operation.strategy = &cusp::prismatic::kEngrave;
    operation.part.floor = random_floor(draw);
    operation.tool = random_tool(draw);
    operation.tolerance.floor = std::exp(draw.uniform(std::log(0.002), std::log(0.05)));
    operation.tolerance.plan = 0.02;
    operation.prismatic = Prismatic{};
    operation.prismatic->depth = kDepth;
    operation.prismatic->chains = {random_curve(draw)};
    return operation;
}

// The highest tip that sampled points of the floor ask for: never above the true one.
double by_samples(const Operation& operation, const Tool& tip, Vec2d at)
{
    constexpr int kSamples = 60;
    double highest = -kUnbounded;
    for (const nurbs::Surface& sheet : operation.part.floor) {
        const double u = (sheet.u_end() - sheet.u_begin()) / kSamples;
        const double v = (sheet.v_end() - sheet.v_begin()) / kSamples;
        for (int i = 0; i <= kSamples; ++i) {
            for (int j = 0; j <= kSamples; ++j) {
                const Vec3d p = point_at(sheet, sheet.u_begin() + i * u, sheet.v_begin() + j * v);
                const double away = norm(in_plan(p) - at);
                if (away < tip.radius) {
                    highest = std::max(highest, p.z - profile_height(tip, away));
                }
            }
        }
    }
    return highest;
}

}  // namespace

TEST_GROUP(EngraveFloorProperty){};

TEST(EngraveFloorProperty, TheTipKeepsItsDepthWithinTheToleranceEverywhere)
{
    constexpr unsigned kSeed = 280;
    const int cases = property_cases(25);
    std::printf("engraving below floors: seed %u, %d cases\n", kSeed, cases);
    Draw draw{std::mt19937{kSeed}};
    double nearest = 0;  // shares of the tolerance
    std::size_t places = 0;
    std::size_t moves = 0;
    for (int n = 0; n < cases; ++n) {
        const Operation operation = random_engraving(draw);
        Job job = plain_job();
        job.stock_top = 20;
        const PlannedOperation planned = plan_engrave(job, operation).front();
        const part_model::PartModel floor{operation.part.floor};
        const Tool tip = toolpath::tip_of(operation.tool);
        Vec3d at{0, 0, 100};
        for (const toolpath::ToolMove& move : planned.path.moves) {
            const Vec3d end = end_of(move);
            const double size = norm(in_plan(end) - in_plan(at));
            if (move.kind != MoveKind::kRapid && size > 0) {
                ++moves;
                const int parts = std::clamp(static_cast<int>(size / 0.02), 2, 200);
                for (int k = 0; k <= parts; ++k) {
                    const Vec3d p = at + (end - at) * (k / static_cast<double>(parts));
                    const auto z = floor.drop_height(tip, p.x, p.y, p.z + kDepth);
                    CHECK(z.has_value());
                    const double off = std::abs(*z - kDepth - p.z) / operation.tolerance.floor;
                    if (off > 1) {
                        std::printf("case %d: %g of the tolerance at %.4f %.4f\n", n, off, p.x,
                                    p.y);
                    }
                    CHECK(off <= 1);
                    nearest = std::max(nearest, off);
                    ++places;
                }
            }
            at = end;
        }
        const Vec2d place{draw.uniform(4, kSide - 4), draw.uniform(4, kSide - 4)};
        const auto z = floor.drop_height(tip, place.x, place.y);
        CHECK(z.has_value() && by_samples(operation, tip, place) <= *z + 1e-6);
    }
    std::printf("%zu moves, %zu places, at most %.3f of the tolerance\n", moves, places, nearest);
    CHECK(places > 0);
}

TEST(EngraveFloorProperty, BoundsOfSlopeAndCurvatureHold)
{
    constexpr unsigned kSeed = 281;
    const int cases = property_cases(200);
    std::printf("bounds of floors: seed %u, %d cases\n", kSeed, cases);
    Draw draw{std::mt19937{kSeed}};
    double tightest = 0;
    for (int n = 0; n < cases; ++n) {
        const nurbs::Surface sheet = random_sheet(draw, draw.uniform(0, 4));
        const drop_cutter::SurfaceBounds around{{sheet}};
        const part_model::PartModel floor{{sheet}};
        const Vec2d low{draw.uniform(2, 20), draw.uniform(2, 20)};
        const Vec2d high = low + Vec2d{draw.uniform(0.1, 5), draw.uniform(0.1, 5)};
        const drop_cutter::SurfaceBounds::Bounds bounds = around.over(low, high);
        Tool point;
        point.shape = ToolShape::kBall;
        point.radius = point.corner_radius = 1e-5;
        const auto height = [&](Vec2d p) {
            return *floor.drop_height(point, p.x, p.y);
        };
        for (int k = 0; k < 10; ++k) {
            const Vec2d a{draw.uniform(low.x, high.x), draw.uniform(low.y, high.y)};
            const Vec2d b{draw.uniform(low.x, high.x), draw.uniform(low.y, high.y)};
            const double size = norm(b - a);
            constexpr double kExact = 1e-5;
            const double bow = height(0.5 * (a + b)) - 0.5 * (height(a) + height(b));
            CHECK(bow <= bounds.down * size * size / 8 + kExact);
            CHECK(-bow <= bounds.up * size * size / 8 + kExact);
            CHECK(std::abs(height(a) - height(b)) <= bounds.slope * size + kExact);
            if (bounds.slope > 0) {
                tightest = std::max(
                    tightest, std::abs(height(a) - height(b)) / (bounds.slope * size + kExact));
            }
        }
        CHECK(std::isfinite(bounds.up) && std::isfinite(bounds.down));
    }
    std::printf("slopes come to %.2f of their bounds\n", tightest);
    CHECK(tightest > 0.5);
}

}  // namespace cusp::test
