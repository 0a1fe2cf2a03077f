// Paths of a few moves, of which it is known what still meets stock.
#include "host_tools/cam/rest_machining/rest_machining.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::rest_machining;
using namespace cusp::toolpath;

namespace {

constexpr RestTolerance kTolerance{0.01, 0.02};
const Tool kTool{2, ToolShape::kFlat, 2, 0};

}  // namespace

TEST_GROUP(RestMachining)
{
    Job job;
    SweptStock stock{0.0};
    PlannedOperation planned;

    void setup() override
    {
        job.clearance = 5;
        planned.path.tool = kTool;
        planned.path.feed = 600;
        planned.path.plunge_feed = 200;
        rapid({0, 0, 5});
        rapid({0, 0, 1});
        add(MoveKind::kPlunge, {0, 0, -2});
        add(MoveKind::kCut, {100, 0, -2});
        rapid({100, 0, 5});
    }
    void rapid(Vec3d to) { add(MoveKind::kRapid, to); }
    void add(MoveKind kind, Vec3d to) { planned.path.moves.push_back({kind, LineTo{to}}); }
    void cleared(double from, double to)
    {
        stock.add(EndProfile{Tool{1, ToolShape::kFlat, 5, 0}}, {from, 0, -2}, {to, 0, -2});
    }
    void keep() { keep_rest(stock, job, {{"folder/first.ngc"}, kTolerance}, planned); }
    const Vec3d end(std::size_t k) { return end_of(planned.path.moves[k]); }
};

TEST(RestMachining, changes_nothing_in_uncut_stock)
{
    const std::size_t moves = planned.path.moves.size();
    keep();
    LONGS_EQUAL(moves, planned.path.moves.size());
    DOUBLES_EQUAL(0, planned.stats.rest->removed_mm, 1e-9);
    DOUBLES_EQUAL(103, planned.stats.rest->kept_mm, 1e-9);
    CHECK(planned.path.comments.empty());
}

TEST(RestMachining, leaves_no_move_where_nothing_is_left)
{
    cleared(-5, 105);
    keep();
    CHECK(planned.path.moves.empty());
    DOUBLES_EQUAL(103, planned.stats.rest->removed_mm, 1e-9);
    DOUBLES_EQUAL(0, planned.stats.rest->kept_mm, 0);
}

TEST(RestMachining, comes_to_what_is_left_through_air_and_leaves_it_so)
{
    // stock is left from x = 45 to 55: the tool meets it from 43 to 57
    cleared(-5, 40);
    cleared(60, 105);
    keep();
    const std::vector<ToolMove>& moves = planned.path.moves;
    LONGS_EQUAL(5, moves.size());
    CHECK(moves[0].kind == MoveKind::kRapid && moves[1].kind == MoveKind::kRapid);
    CHECK(moves[2].kind == MoveKind::kPlunge && moves[3].kind == MoveKind::kCut);
    CHECK(end(0) == (Vec3d{end(1).x, 0, 5}));
    DOUBLES_EQUAL(42, end(1).x, 0.26);
    DOUBLES_EQUAL(-1, end(1).z, 1e-9);
    DOUBLES_EQUAL(58, end(3).x, 0.26);
    DOUBLES_EQUAL(5, end(4).z, 1e-9);
    DOUBLES_EQUAL(16, planned.stats.rest->kept_mm, 0.52);
    STRCMP_EQUAL("rest machining after first.ngc: 16 of 103 mm, tolerance 0.01 mm",
                 planned.path.comments.front().c_str());
}

TEST(RestMachining, comes_down_beside_a_wall_that_the_tool_would_touch)
{
    cleared(-5, 40);
    cleared(60, 105);
    for (std::size_t k = 0; k < planned.path.moves.size(); ++k) {
        std::get<LineTo>(planned.path.moves[k].shape).end.y = 3.005;  // 0.005 mm into the wall
    }
    keep();
    const std::vector<ToolMove>& moves = planned.path.moves;
    LONGS_EQUAL(6, moves.size());
    CHECK(moves[1].kind == MoveKind::kRapid && moves[2].kind == MoveKind::kPlunge);
    CHECK(moves[3].kind == MoveKind::kLink);
    CHECK(end(1).y < 3.0 - 0.1);
    DOUBLES_EQUAL(3.005, end(3).y, 0);
}

TEST(RestMachining, goes_on_through_a_short_gap_and_over_a_long_one)
{
    cleared(20, 24);   // a gap of 6 mm
    cleared(50, 100);  // one of 56
    add(MoveKind::kPlunge, {100, 0, -2});
    add(MoveKind::kCut, {150, 0, -2});
    rapid({150, 0, 5});
    keep();
    int rapids = 0;
    for (const ToolMove& move : planned.path.moves) {
        rapids += move.kind == MoveKind::kRapid ? 1 : 0;
    }
    LONGS_EQUAL(6, rapids);
    LONGS_EQUAL(2, planned.stats.retracts);
}

TEST(RestMachining, keeps_a_curve_whole_that_meets_stock_anywhere)
{
    cleared(-5, 55);
    planned.path.moves[3] = {MoveKind::kCut,
                             NurbsTo{{1, {0, 0, 1, 1}, {{0, 0, -2}, {60, 0, -2}}, {1, 1}}}};
    add(MoveKind::kRapid, {60, 0, 5});
    planned.path.moves[4] = {MoveKind::kRapid, LineTo{{60, 0, 5}}};
    keep();
    DOUBLES_EQUAL(60, planned.stats.rest->kept_mm, 1.1);
    planned.stats = {};
    cleared(50, 70);
    keep();
    CHECK(planned.path.moves.empty());
}

TEST(RestMachining, leaves_out_holes_as_a_whole)
{
    stock.add(EndProfile{kTool}, {0, 0, 1}, {0, 0, -6});
    planned.path.moves.clear();
    planned.path.cycle = DrillCycle{1, 2};
    for (const double x : {0.0, 20.0}) {
        rapid({x, 0, 5});
        rapid({x, 0, 1});
        add(MoveKind::kPlunge, {x, 0, -2});
        rapid({x, 0, 1});
        add(MoveKind::kPlunge, {x, 0, -4});
        rapid({x, 0, 5});
    }
    keep();
    LONGS_EQUAL(6, planned.path.moves.size());
    DOUBLES_EQUAL(20, end(0).x, 0);
    LONGS_EQUAL(1, planned.stats.retracts);
}

TEST(RestMachining, tolerates_a_twentieth_of_a_scallop_and_no_more_than_the_tolerances)
{
    Operation operation;
    operation.tolerance.plan = 0.02;
    operation.tolerance.floor = 0.01;
    DOUBLES_EQUAL(0.01, rest_tolerance(operation).surface, 1e-12);
    operation.tolerance.scallop = 0.1;
    DOUBLES_EQUAL(0.005, rest_tolerance(operation).surface, 1e-12);
    operation.tolerance.scallop = 0.011;
    DOUBLES_EQUAL(0.001, rest_tolerance(operation).surface, 1e-12);
    operation.prismatic.emplace();
    DOUBLES_EQUAL(0.02, rest_tolerance(operation).wall, 1e-12);
    operation.rest.tolerance = 0.05;
    DOUBLES_EQUAL(0.05, rest_tolerance(operation).wall, 1e-12);
}
