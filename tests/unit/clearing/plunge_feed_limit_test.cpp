// Descents through stock and through air.
#include "host_tools/cam/clearing/plunge_feed_limit.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::clearing;
using namespace cusp::job;
using namespace cusp::offset;
using namespace cusp::toolpath;

namespace {

constexpr Box2d kBox{-10, -10, 30, 10};

// In over the origin, and on.
std::vector<PlannedOperation> path_of(const std::vector<Vec3d>& cuts)
{
    PlannedOperation planned;
    planned.path.tool = {1, ToolShape::kFlat, 3.0, 0.0};
    planned.path.feed = 1200;
    planned.path.plunge_feed = 300;
    planned.path.moves = {{MoveKind::kRapid, LineTo{{0, 0, 5}}}};
    for (const Vec3d end : cuts) {
        planned.path.moves.push_back({MoveKind::kCut, LineTo{end}});
    }
    return {planned};
}

std::vector<ToolMove> slowed(std::vector<PlannedOperation> planned)
{
    Job job;
    job.stock_top = 0.0;
    limit_plunge_feed(planned, job, kBox);
    return planned.front().path.moves;
}

double end_z(const ToolMove& move) { return std::get<LineTo>(move.shape).end.z; }

}  // namespace

TEST_GROUP(PlungeFeedLimit){};

TEST(PlungeFeedLimit, SlowsDownFromJustAboveTheStockOn)
{
    const std::vector<ToolMove> moves = slowed(path_of({{0, 0, -2}}));
    LONGS_EQUAL(3, moves.size());
    CHECK(moves[1].kind == MoveKind::kCut);
    DOUBLES_EQUAL(0.1, end_z(moves[1]), 0.02);
    CHECK(moves[2].kind == MoveKind::kPlungingCut);
    DOUBLES_EQUAL(-2.0, end_z(moves[2]), 1e-12);
}

TEST(PlungeFeedLimit, KeepsTheFeedWhereTheStockIsCut)
{
    const std::vector<ToolMove> moves = slowed(path_of({{0, 0, -2}, {0, 0, 1}, {0, 0, -2}}));
    LONGS_EQUAL(5, moves.size());
    CHECK(moves[3].kind == MoveKind::kCut);
    CHECK(moves[4].kind == MoveKind::kCut);
}

TEST(PlungeFeedLimit, AreSlopesSteeperThanBothFeedsAllow)
{
    // Down a quarter of the way at most: 300 of 1200 mm/min.
    std::vector<ToolMove> moves = slowed(path_of({{0, 0, 0}, {8, 0, -4}}));
    CHECK(moves[2].kind == MoveKind::kPlungingCut);
    moves = slowed(path_of({{0, 0, 0}, {16, 0, -3.9}}));
    CHECK(moves[2].kind == MoveKind::kCut);
}
