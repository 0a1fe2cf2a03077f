#include "host_tools/cam/contour_pocket/open_sides.hpp"

#include <algorithm>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/unit/offset/polygons.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace job;
using namespace toolpath;
using offset::Region2d;

namespace {

constexpr double kRadius = 3.0;
constexpr double kClearance = 3.01;

nurbs::Curve side(Vec2d a, Vec2d b)
{
    return {1, {0.0, 0.0, 1.0, 1.0}, {{a.x, a.y, 0.0}, {b.x, b.y, 0.0}}, {1.0, 1.0}};
}

Loop loop(double x0, double y0, double x1, double y1)
{
    const Vec2d p[] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    return {side(p[0], p[1]), side(p[1], p[2]), side(p[2], p[3]), side(p[3], p[0])};
}

// Stock of 80 x 60 mm, 8 mm deep.
Job plate()
{
    Job job;
    job.file = "job.toml";
    job.clearance = 5.0;
    job.feed = 1000.0;
    job.plunge_feed = 250.0;
    job.stock_x = {0.0, 80.0};
    job.stock_y = {0.0, 60.0};
    return job;
}

Operation pocket(const Loop& outline)
{
    Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    operation.outline.boundary = outline;
    operation.outline.boundary_file = "plate.dxf#pocket";
    operation.part.floor_files = {"floor.json"};
    nurbs::Surface floor;
    floor.degree_u = floor.degree_v = 1;
    floor.size_u = floor.size_v = 2;
    floor.knots_u = floor.knots_v = {0.0, 0.0, 1.0, 1.0};
    floor.points = {{-5, -5, -8}, {-5, 85, -8}, {85, -5, -8}, {85, 85, -8}};
    floor.weights = {1.0, 1.0, 1.0, 1.0};
    operation.part.floor = {floor};
    operation.tool = {1, ToolShape::kFlat, kRadius, 0.0};
    operation.tools = {operation.tool};
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.scallop = 0.05;
    operation.passes.max_engagement = 60.0;
    return operation;
}

std::optional<OpenSides> sides_of(const Loop& outline)
{
    const Operation operation = pocket(outline);
    return open_sides(plate(), operation, make_region(operation, 0.001), kClearance);
}

double figure(const PlannedOperation& planned, const std::string& name)
{
    const auto& counts = planned.stats.counts;
    const auto found = std::find_if(counts.begin(), counts.end(),
                                    [&](const auto& count) { return count.first == name; });
    return found == counts.end() ? -1.0 : found->second;
}

TEST_GROUP(OpenSides){};

TEST(OpenSides, APocketInsideTheStockIsClosed)
{
    CHECK(!sides_of(loop(10, 10, 79, 50)));
    CHECK(!sides_of(loop(90, 10, 120, 50)));  // beside it
    Job endless = plate();
    endless.stock_x.reset();
    const Operation operation = pocket(loop(40, 10, 80, 50));
    CHECK(!open_sides(endless, operation, make_region(operation, 0.001), kClearance));
}

TEST(OpenSides, OnTheEdgeAndBeyondAreTheSame)
{
    const auto on = sides_of(loop(40, 10, 80, 50));
    const auto beyond = sides_of(loop(40, 10, 84, 50));
    CHECK(on && beyond);
    DOUBLES_EQUAL(40 * 40, area(on->in_stock), 0.1);
    DOUBLES_EQUAL(area(on->region), area(beyond->region), 1e-3);
    LONGS_EQUAL(1, on->region.contours.size());
    CHECK(contains(on->region, {83, 9}));     // past the wall's end
    CHECK(!contains(on->region, {79.5, 9}));  // the wall
    CHECK(!contains(on->region, {-1, 30}));   // beside the other side
    CHECK(contains(on->air, {81, 30}));
    CHECK(!contains(on->air, {79, 30}));
}

TEST(OpenSides, StartsMeetNeitherStockNorWalls)
{
    for (const Loop& outline : {loop(40, 10, 80, 50), loop(-2, 40, 30, 65), loop(-1, -1, 81, 61)}) {
        const auto open = sides_of(outline);
        CHECK(open && !open->starts.contours.empty());
        for (const offset::Edge& edge : edges_of(open->starts)) {
            for (const double share : {0.0, 0.3, 0.7}) {
                const Vec2d p = point_on(edge, share);
                const double beside =
                    std::hypot(std::max({-p.x, p.x - 80, 0.0}), std::max({-p.y, p.y - 60, 0.0}));
                CHECK(beside >= kRadius + 0.002);
                CHECK(distance_to(open->region, p) >= kClearance - 1e-5);
            }
        }
    }
}

TEST(OpenSides, AnIslandAndTwoSidesKeepTheirWalls)
{
    Operation operation = pocket(loop(-2, 40, 82, 55));  // through the stock
    operation.outline.islands = {loop(30, 45, 36, 50)};
    operation.outline.island_files = {"plate.dxf#island"};
    const auto open = open_sides(plate(), operation, make_region(operation, 0.001), kClearance);
    CHECK(open.has_value());
    LONGS_EQUAL(2, open->region.contours.size());
    LONGS_EQUAL(2, open->air.contours.size());
    CHECK(!contains(open->region, {33, 47}));
    DOUBLES_EQUAL(80 * 15 - 30, area(open->in_stock), 0.2);
}

TEST(OpenSides, ThePocketIsEnteredFromTheSideAndItsWallsAreClearedPastTheEdge)
{
    const std::vector<PlannedOperation> planned =
        plan_contour_pocket(plate(), pocket(loop(50, 10, 80, 40)));
    const PlannedOperation& only = planned.front();
    DOUBLES_EQUAL(0, figure(only, "entries"), 0);
    DOUBLES_EQUAL(1, figure(only, "open_pocket"), 0);
    DOUBLES_EQUAL(2, figure(only, "rest_places"), 0);  // two corners, not those at the edge
    CHECK(figure(only, "engagement_bound_deg") <= 60.0);
    double farthest = 0.0;
    for (const ToolMove& move : only.path.moves) {
        const Vec3d end = end_of(move);
        // Down to depth only beside the stock.
        CHECK(move.kind != MoveKind::kPlunge || end.x >= 83.0);
        farthest = move.kind == MoveKind::kCut ? std::max(farthest, end.x) : farthest;
    }
    CHECK(farthest > 80.0);
}

Loop through(const std::vector<Vec2d>& corners)
{
    Loop out;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        out.push_back(side(corners[i], corners[(i + 1) % corners.size()]));
    }
    return out;
}

// A quarter of a circle about (0, 0), by a rational parabola, four times.
Loop circle(double radius)
{
    const double w = std::sqrt(0.5);
    Loop out;
    Vec2d from{radius, 0.0};
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Vec2d to{-from.y, from.x};
        const Vec2d corner = from + to;
        out.push_back({2,
                       {0.0, 0.0, 0.0, 1.0, 1.0, 1.0},
                       {{from.x, from.y, 0.0}, {corner.x, corner.y, 0.0}, {to.x, to.y, 0.0}},
                       {1.0, w, 1.0}});
        from = to;
    }
    return out;
}

std::optional<OpenSides> sides_in(const std::vector<Loop>& stock, const Loop& outline)
{
    Job job = plate();
    job.stock_outline = stock;
    const Operation operation = pocket(outline);
    return open_sides(job, operation, make_region(operation, 0.001), kClearance);
}

TEST(OpenSides, AreThoseOfTheStocksOutline)
{
    CHECK(!sides_in({circle(40)}, loop(-15, -10, 15, 10)));  // in it
    CHECK(!sides_in({circle(40)}, loop(45, -10, 60, 10)));   // beside it
    const auto open = sides_in({circle(40)}, loop(0, -12, 60, 12));
    CHECK(open.has_value());
    CHECK(contains(open->air, {40.1, 5}));
    CHECK(!contains(open->air, {39.6, 5}));
    CHECK(contains(open->region, {36, 18}));   // beside the bar, past the wall's end
    CHECK(!contains(open->region, {30, 18}));  // the wall
    CHECK(!contains(open->region, {-41, 0}));
    for (const offset::Edge& edge : edges_of(open->starts)) {
        CHECK(norm(edge.start) >= 40 + kRadius + 0.002);
    }
    const auto ring = sides_in({circle(40), circle(12)}, loop(-20, -8, 20, 8));
    CHECK(ring && contains(ring->starts, {5, 0}));
    CHECK(!contains(ring->starts, {10, 0}));
}

// A wall of 4 mm between the pocket's ground and another notch.
TEST(OpenSides, AcrossAThinWallIsOtherGround)
{
    const auto open = sides_in({through({{-40, -40},
                                         {40, -40},
                                         {40, 40},
                                         {26, 40},
                                         {26, 0},
                                         {12, 0},
                                         {12, 40},
                                         {8, 40},
                                         {8, 10},
                                         {-8, 10},
                                         {-8, 40},
                                         {-40, 40}})},
                               loop(-12, -20, 8, 15));
    CHECK(open.has_value());
    CHECK(contains(open->region, {0, 18}));
    CHECK(contains(open->starts, {0, 16}));
    CHECK(!contains(open->region, {15.5, 12}));
    CHECK(!contains(open->starts, {15.5, 12}));
    LONGS_EQUAL(1, open->starts.contours.size());
}

TEST(OpenSides, APocketBesideTheStockIsWarnedOf)
{
    const std::vector<PlannedOperation> planned =
        plan_contour_pocket(plate(), pocket(loop(-3, 62, 25, 84)));
    const auto& warnings = planned.front().stats.warnings;
    CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) {
        return text.find("the pocket lies beside the stock") != std::string::npos;
    }));
}

}  // namespace

}  // namespace cusp::test
