// Reordered operations: fewer changes of tool, and at every point of the plan the cuts stay in
// order.
#include "host_tools/geometry/toolpath/tool_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::toolpath;

namespace {

constexpr double kClearance = 5;

struct Square {
    double x;
    double y;
    double size;
};

PlannedOperation square(int tool, double radius, Square s)
{
    PlannedOperation planned;
    planned.path.tool = {tool, ToolShape::kFlat, radius, 0};
    const auto cut = [&](double x, double y) {
        planned.path.moves.push_back({MoveKind::kCut, LineTo{{x, y, -1}}});
    };
    planned.path.moves.push_back({MoveKind::kRapid, LineTo{{s.x, s.y, kClearance}}});
    cut(s.x, s.y);
    cut(s.x + s.size, s.y);
    cut(s.x + s.size, s.y + s.size);
    cut(s.x, s.y + s.size);
    planned.path.moves.push_back({MoveKind::kRapid, LineTo{{s.x, s.y + s.size, kClearance}}});
    return planned;
}

int changes(const std::vector<PlannedOperation>& operations, const std::vector<std::size_t>& order)
{
    int count = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        count += operations[order[i]].path.tool.number != operations[order[i - 1]].path.tool.number
                     ? 1
                     : 0;
    }
    return count;
}

}  // namespace

TEST_GROUP(ToolOrder){};

TEST(ToolOrder, RoughsThreePocketsBeforeItFinishesThem)
{
    std::vector<PlannedOperation> operations;
    for (int pocket = 0; pocket < 3; ++pocket) {
        operations.push_back(square(1, 4, {40.0 * pocket, 0, 20}));
        operations.push_back(square(2, 3, {40.0 * pocket, 0, 20}));
    }
    CHECK((tool_order(operations, kClearance) == std::vector<std::size_t>{0, 2, 4, 1, 3, 5}));
}

TEST(ToolOrder, KeepsTheOrderOfCutsThatOverlap)
{
    const std::vector<PlannedOperation> operations{
        square(1, 4, {0, 0, 20}), square(2, 3, {0, 0, 20}), square(1, 4, {22, 0, 20})};
    CHECK((tool_order(operations, kClearance) == std::vector<std::size_t>{0, 1, 2}));
}

TEST(ToolOrder, SweepsArcsAndCurves)
{
    // An arc that bulges into the neighbour's ground, though its ends do not.
    auto first = square(2, 3, {0, 0, 20});
    first.path.moves.push_back(
        {MoveKind::kCut, ArcTo{{0, 0, -1}, {0, 10, -1}, ArcPlane::kXY, false}});
    const auto second = square(1, 3, {-40, 0, 28});
    const std::vector<PlannedOperation> operations{square(1, 3, {100, 0, 5}), first, second};
    CHECK((tool_order(operations, kClearance) == std::vector<std::size_t>{0, 1, 2}));
}

// The oracle: a raster of the ground that notes who cuts each cell, one after the other.
TEST(ToolOrder, NoCellSeesAnotherOrder)
{
    constexpr unsigned kSeed = 1;
    std::printf(" seed %u", kSeed);
    std::mt19937 random{kSeed};
    constexpr int kCells = 60;
    int fewer = 0;
    for (int round = 0; round < 500; ++round) {
        std::vector<PlannedOperation> operations;
        std::vector<Square> squares;
        std::uniform_real_distribution<> place{0, 50};
        const int count = 2 + static_cast<int>(random() % 8);
        for (int i = 0; i < count; ++i) {
            squares.push_back({place(random), place(random), place(random) / 8});
            operations.push_back(square(1 + static_cast<int>(random() % 3), 1.5, squares.back()));
        }
        const auto order = tool_order(operations, kClearance);
        CHECK_EQUAL(operations.size(), order.size());
        const auto cutters_of = [&](double x, double y, const auto& places) {
            std::vector<std::size_t> cutters;
            for (const std::size_t i : places) {
                const Square& s = squares[i];
                const double dx = std::max({s.x - x, x - s.x - s.size, 0.0});
                const double dy = std::max({s.y - y, y - s.y - s.size, 0.0});
                if (std::hypot(dx, dy) <= 1.5) {
                    cutters.push_back(i);
                }
            }
            return cutters;
        };
        std::vector<std::size_t> given;
        for (std::size_t i = 0; i < operations.size(); ++i) {
            given.push_back(i);
        }
        int other = 0;
        for (int x = 0; x < kCells; ++x) {
            for (int y = 0; y < kCells; ++y) {
                other += cutters_of(x, y, given) == cutters_of(x, y, order) ? 0 : 1;
            }
        }
        CHECK_EQUAL(0, other);
        CHECK(changes(operations, order) <= changes(operations, given));
        fewer += changes(operations, order) < changes(operations, given) ? 1 : 0;
    }
    CHECK(fewer > 50);
}
