// Proofs of air against samples of random stocks.
#include "host_tools/cam/rest_machining/swept_stock.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::rest_machining;
using namespace cusp::toolpath;

namespace {

const Tool kFlat{1, ToolShape::kFlat, 5, 0};
const Tool kSmallFlat{2, ToolShape::kFlat, 1.5, 0};
const Tool kBall{3, ToolShape::kBall, 3, 3};

// Depth of stock in the tool, at points 0.05 mm apart.
double sampled_depth(const SweptStock& stock, const ToolSweep& tool)
{
    constexpr double kPitch = 0.05;
    double deepest = -kUnbounded;
    for (double x = tool.low().x; x < tool.high().x; x += kPitch) {
        for (double y = tool.low().y; y < tool.high().y; y += kPitch) {
            const double over = tool.height({x, y});
            deepest = over < kInfinite ? std::max(deepest, stock.height({x, y}) - over) : deepest;
        }
    }
    return deepest;
}

}  // namespace

TEST_GROUP(SweptStock){};

TEST(SweptStock, is_as_high_as_the_lowest_sweep_or_its_top)
{
    SweptStock stock{1.0};
    DOUBLES_EQUAL(1.0, stock.height({0, 0}), 0);
    stock.add(EndProfile{kFlat}, {0, 0, -2}, {20, 0, -2});
    stock.add(EndProfile{kBall}, {0, 0, -3}, {20, 0, -3});
    DOUBLES_EQUAL(-3.0, stock.height({10, 0}), 1e-12);
    DOUBLES_EQUAL(-2.0, stock.height({10, 4}), 1e-12);
    DOUBLES_EQUAL(1.0, stock.height({10, 5.1}), 0);
}

TEST(SweptStock, lets_a_small_tool_follow_the_wall_of_a_large_one)
{
    SweptStock stock{0.0};
    stock.add(EndProfile{kFlat}, {0, 0, -4}, {40, 0, -4});
    const Vec3d from{0, 3.5, -4};
    const Vec3d to{40, 3.5, -4};
    CHECK(stock.is_clear({EndProfile{kSmallFlat}, from, to}));
    CHECK(!stock.is_clear({EndProfile{kSmallFlat}, from + Vec3d{0, 0.01, 0}, to}));
    CHECK(stock.is_clear({EndProfile{kSmallFlat, 0.02}, from + Vec3d{0, 0.01, 0}, to}));
    CHECK(!stock.is_clear({EndProfile{kSmallFlat}, from, to + Vec3d{0, 0, -0.001}}));
}

TEST(SweptStock, lets_a_tool_follow_a_round_wall_made_of_short_moves)
{
    SweptStock stock{0.0};
    constexpr int kMoves = 200;
    const auto at = [](double radius, int i) {
        const double angle = 2 * 3.14159265358979 * i / kMoves;
        return Vec3d{radius * std::cos(angle), radius * std::sin(angle), -3};
    };
    for (int i = 0; i < kMoves; ++i) {
        stock.add(EndProfile{kFlat}, at(20, i), at(20, i + 1));
    }
    for (int i = 0; i < kMoves; i += 7) {
        CHECK(stock.is_clear({EndProfile{kSmallFlat, 0.02}, at(23.5, i), at(23.5, i + 1)}));
        CHECK(!stock.is_clear({EndProfile{kSmallFlat, 0.02}, at(23.55, i), at(23.55, i + 1)}));
    }
}

TEST(SweptStock, of_fine_passes_of_a_ball_is_clear_for_the_same_passes)
{
    const auto at = [](double x, double y) {
        return Vec3d{x, y, 0.5 * std::sin(x / 3)};
    };
    SweptStock stock{5.0};
    for (double y = 0; y <= 6; y += 0.3) {
        for (double x = 0; x < 6; x += 0.5) {
            stock.add(EndProfile{kBall}, at(x, y), at(x + 0.5, y));
        }
    }
    const Vec3d from = at(2, 3);
    const Vec3d to = at(2.5, 3);
    CHECK(stock.is_clear({EndProfile{kBall, 0.001}, from, to}));
    // between two passes the cusp is 0.0037 mm high
    const Vec3d between{0, 0.15, 0};
    CHECK(stock.is_clear({EndProfile{kBall, 0.006}, from + between, to + between}));
    CHECK(!stock.is_clear({EndProfile{kBall, 0.001}, from + between, to + between}));
}

TEST(SweptStock, never_calls_stock_air)
{
    std::mt19937 draw{17};
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(draw);
    };
    int clear = 0;
    int met = 0;
    int unproven = 0;  // a rim comes nearer to a wall than the samples
    for (int trial = 0; trial < 12; ++trial) {
        SweptStock stock{0.0};
        Vec3d at{0, 0, -1};
        for (int i = 0; i < 25; ++i) {
            const double x = number(-8, 8);
            const double y = number(-8, 8);
            const Vec3d to{x, y, std::min(-0.5, at.z + number(-0.5, 0.3))};
            stock.add(EndProfile{i % 2 == 0 ? kFlat : kBall}, at, to);
            at = to;
        }
        for (int i = 0; i < 25; ++i) {
            const double x = number(-6, 6);
            const double y = number(-6, 6);
            const double z = number(-4, 0);
            const Vec3d from{x, y, z};
            const Vec3d to{x + number(-1, 1), y, z + number(-0.2, 0.2)};
            const ToolSweep tool{EndProfile{i % 2 == 0 ? kSmallFlat : kBall}, from, to};
            const double depth = sampled_depth(stock, tool);
            const bool is_clear = stock.is_clear(tool);
            CHECK(!is_clear || depth <= 1e-6);
            unproven += !is_clear && depth < -0.01 ? 1 : 0;
            clear += is_clear ? 1 : 0;
            met += is_clear ? 0 : 1;
        }
    }
    CHECK(clear > 30);
    CHECK(met > 30);
    CHECK(unproven < 10);
}
