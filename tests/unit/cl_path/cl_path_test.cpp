#include "host_tools/cam/cl_path/cl_path.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/cl_path/station_row.hpp"
#include "tests/support/holed_sheet.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace cl_path;
using namespace drop_cutter;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kAccuracy = 0.002;
const Tool kBall{1, ToolShape::kBall, 6.0, 6.0};

// A bicubic patch over [0, size] x [0, size] with these heights of its control points.
Surface hill(double size, double rise)
{
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = s.size_v = 4;
    s.knots_u = s.knots_v = {0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const bool inside = i % 3 != 0 && j % 3 != 0;
            s.points.push_back({size * i / 3.0, size * j / 3.0, inside ? rise : 0.0});
            s.weights.push_back(1.0);
        }
    }
    return s;
}

// A triangle's profile along y: from x - half up to `top` at x and down again.
std::vector<Surface> bead(double x, double half, double top, double size)
{
    std::vector<Surface> sides;
    for (const double foot : {x - half, x + half}) {
        Surface s;
        s.degree_u = s.degree_v = 1;
        s.size_u = s.size_v = 2;
        s.knots_u = s.knots_v = {0.0, 0.0, 1.0, 1.0};
        s.points = {{foot, 0.0, 0.0}, {foot, size, 0.0}, {x, 0.0, top}, {x, size, top}};
        s.weights = {1.0, 1.0, 1.0, 1.0};
        sides.push_back(s);
    }
    return sides;
}

ClPathSettings settings()
{
    ClPathSettings s;
    s.plan_tolerance = 0.02;
    s.height_tolerance = 0.016;
    s.clearance_reserve = kAccuracy;
    s.spacing = 0.54;
    return s;
}

// Height of the path's tip above its lowest allowed position, densely sampled.
double most_over(const ClPath& path, const DropCutter& floor)
{
    double most = 0.0;
    Vec3d from = path.start;
    for (const ClMove& move : path.moves) {
        constexpr int kPlaces = 60;
        for (int i = 0; i <= kPlaces; ++i) {
            const Vec3d tip = from + (move.end - from) * (static_cast<double>(i) / kPlaces);
            most = std::max(most, tip.z - floor.tip_height({tip.x, tip.y}));
        }
        from = move.end;
    }
    return most;
}

// mm: length of the path in plan where its tip is higher than that by more than `over`.
double length_over(const ClPath& path, const DropCutter& floor, double over)
{
    constexpr int kPlaces = 20;
    double sum = 0.0;
    Vec3d from = path.start;
    for (const ClMove& move : path.moves) {
        const double length = std::hypot(move.end.x - from.x, move.end.y - from.y);
        for (int i = 0; i < kPlaces; ++i) {
            const Vec3d tip = from + (move.end - from) * ((i + 0.5) / kPlaces);
            const bool lifted = tip.z - floor.tip_height({tip.x, tip.y}) > over;
            sum += lifted ? length / kPlaces : 0.0;
        }
        from = move.end;
    }
    return sum;
}

}  // namespace

TEST_GROUP(ClPath){};

TEST(ClPath, StationsBetweenLookupsAreAsHighAsTheFloorSays)
{
    const DropCutter floor{{hill(60.0, 4.0)}, kBall, kAccuracy};
    const std::vector<Edge> plan{line_edge({10.0, 11.0}, {45.0, 25.0}),
                                 line_edge({45.0, 25.0}, {20.0, 50.0})};
    const PathFloor under{floor};
    const StationRow dense = stations_along(plan, &under, {0.54, 0.02, 0.016, false});
    const StationRow sparse = stations_along(plan, &under, {0.54, 0.02, 0.016, true});
    CHECK_EQUAL(dense.corners.size(), sparse.corners.size());
    int interpolated = 0;
    for (const Station& s : sparse.stations) {
        const double height = floor.tip_height(s.at);
        DOUBLES_EQUAL(height, s.height, 0.06 * 0.016 + kAccuracy);
        interpolated += height != s.height ? 1 : 0;
    }
    CHECK(interpolated > static_cast<int>(sparse.stations.size() / 2));
}

TEST(ClPath, ARidgeBetweenLookupsIsFollowed)
{
    for (int i = 0; i < 40; ++i) {
        std::vector<Surface> surfaces = bead(30.0 + 0.05 * i, 0.5, 0.06, 60.0);
        surfaces.push_back(hill(60.0, 0.0));
        const DropCutter floor{surfaces, kBall, kAccuracy};
        const ClPath path = drop_path({line_edge({5.0, 20.0}, {55.0, 21.0})}, floor, settings());
        CHECK(path.least_clearance >= 0.0);
        CHECK(most_over(path, floor) < settings().height_tolerance + kAccuracy);
    }
}

// Moves that deviate from the path towards a cliff beside it are raised there, and not over all of
// their length.
TEST(ClPath, AMoveThatGrazesACliffIsRaisedOnlyThere)
{
    constexpr int kCases = 40;
    double longest = 0.0;
    for (int i = 0; i < kCases; ++i) {
        const double away = 5.0 + 0.02 * i;  // the ball passes the plate's edge at 5.196 mm
        std::vector<Surface> floor{hill(60.0, 0.0), hill(1.0, 0.0)};
        for (Vec3d& p : floor.back().points) {
            p = p + Vec3d{29.5, 9.0, 3.0};
        }
        const DropCutter tips{floor, kBall, kAccuracy};
        ClPathSettings laying = settings();
        laying.arcs = true;
        // A circle of 200 mm that comes nearest to the plate beside its middle.
        const double y = 10.0 + away;
        const Vec2d centre{30.0, y + 200.0};
        std::vector<Edge> plan;
        Vec2d from{10.0, centre.y - std::sqrt(200.0 * 200.0 - 400.0)};
        for (int k = 1; k <= 20; ++k) {
            const double x = -20.0 + 2.0 * k;
            const Vec2d to{30.0 + x, centre.y - std::sqrt(200.0 * 200.0 - x * x)};
            plan.push_back(line_edge(from, to));
            from = to;
        }
        const ClPath path = drop_path(plan, tips, laying);
        DOUBLES_EQUAL(0.0, path.least_clearance, 1e-9);
        const double lifted = length_over(path, tips, 3.0 * laying.height_tolerance);
        longest = std::max(longest, lifted);
    }
    CHECK(longest < 0.2 * kBall.radius);
}

// Into a hole and out of it: moves raised at its rim leave the long moves beside it low.
TEST(ClPath, LongMovesUpToARimStayDown)
{
    const Tool ball{1, ToolShape::kBall, 2.0, 2.0};
    const DropCutter tips{holed_floor(0.25), ball, kAccuracy};
    ClPathSettings laying = settings();
    laying.spacing = 0.2;
    laying.arcs = true;
    double longest = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double turn = 0.1 * i;
        const Vec2d way{std::cos(turn), std::sin(turn)};
        const Vec2d middle = Vec2d{15.0, 15.0} + left_normal(way) * (0.08 * i - 2.4);
        std::vector<Edge> plan;
        for (int k = -10; k < 10; ++k) {
            const auto place = [&](double x) {
                return middle + way * x + left_normal(way) * (0.005 * x * x);
            };
            plan.push_back(line_edge(place(k), place(k + 1)));
        }
        const ClPath path = drop_path(plan, tips, laying);
        DOUBLES_EQUAL(0.0, path.least_clearance, 1e-9);
        longest = std::max(longest, length_over(path, tips, 3.0 * laying.height_tolerance));
    }
    CHECK(longest < 0.2 * ball.radius);
}

// A curve with too few samples: lines start and end where it would, and are nowhere farther from
// the path than allowed.
TEST(ClPath, LinesInPlaceOfAShortCurveStayBesideTheWay)
{
    const DropCutter tips{{hill(60.0, 0.0)}, kBall, kAccuracy};
    ClPathSettings laying = settings();
    laying.arcs = true;
    laying.nurbs = true;
    for (int i = 0; i < 60; ++i) {
        const double radius = 1.0 + 0.15 * (i % 10);
        const Vec2d centre{30.0, 30.0};
        const auto place = [&](double angle) {
            return centre + Vec2d{std::cos(angle), std::sin(angle)} * radius;
        };
        const double end = 0.2 + 0.01 * i;
        const std::vector<Edge> plan{line_edge({40.0, 25.0}, place(0.0)),
                                     arc_edge(place(0.0), place(end), centre, 1),
                                     line_edge(place(end), {50.0, 40.0})};
        const ClPath path = drop_path(plan, tips, laying);
        Vec3d from = path.start;
        for (const ClMove& move : path.moves) {
            for (int k = 0; k <= 40 && move.turn == 0 && move.curve.points.empty(); ++k) {
                const Vec3d p = from + (move.end - from) * (k / 40.0);
                const double off =
                    std::min({distance_to(plan[0], {p.x, p.y}), distance_to(plan[1], {p.x, p.y}),
                              distance_to(plan[2], {p.x, p.y})});
                CHECK(off <= laying.plan_tolerance + kWrittenStep);
            }
            from = move.end;
        }
    }
}

// Horizontal and vertical moves are for cliffs. On a steep floor without one, a shortfall of a
// micrometre gives a raise of a micrometre.
TEST(ClPath, MovesUpASmoothSteepFloorStandNoMoreThanTheBandOverIt)
{
    const Tool tools[] = {{1, ToolShape::kBall, 2.0, 2.0},
                          {1, ToolShape::kBull, 2.0, 0.7},
                          {1, ToolShape::kFlat, 2.0, 0.0}};
    ClPathSettings laying = settings();
    laying.height_tolerance = 0.008;
    laying.spacing = 0.2;
    constexpr double kSteepest = 3.3;
    for (const Tool& tool : tools) {
        for (int i = 0; i < 3; ++i) {
            const DropCutter floor{{hill(20.0, 40.0)}, tool, kAccuracy};
            const double x = 3.0 + 1.7 * i;
            laying.arcs = i % 2 == 0;
            const ClPath path = drop_path({line_edge({x, 3.0}, {20.0 - x, 17.0})}, floor, laying);
            DOUBLES_EQUAL(0.0, path.least_clearance, 1e-9);
            // beside its path a move is higher by as much as the floor falls there
            CHECK(most_over(path, floor) <=
                  2.0 * (laying.height_tolerance + kSteepest * laying.plan_tolerance));
        }
    }
}

TEST(ClPath, ALevelOverAHillIsOneMoveFromWhereTheTipIs)
{
    const DropCutter floor{{hill(60.0, 4.0)}, kBall, kAccuracy};
    ClPathSettings laying = settings();
    laying.plan_tolerance = 1e-6;
    laying.min_z = 5.0;
    laying.level_at_min_z = true;
    laying.start_z = 5.0;
    const std::vector<Edge> plan{line_edge({10.0, 11.0}, {50.0, 11.0}),
                                 line_edge({50.0, 11.0}, {50.0, 40.0})};
    const ClPath over = drop_path(plan, floor, laying);
    LONGS_EQUAL(2, over.moves.size());
    DOUBLES_EQUAL(5.0, over.start.z, 1e-12);
    for (const ClMove& move : over.moves) {
        DOUBLES_EQUAL(5.0, move.end.z, 1e-12);
    }
    // If the hill reaches through the level, moves follow it and stay straight in plan.
    laying.min_z = laying.start_z.emplace(1.0);
    const ClPath path = drop_path(plan, floor, laying);
    DOUBLES_EQUAL(1.0, path.start.z, 1e-12);
    CHECK(path.moves.size() > 2 && path.least_clearance >= 0.0);
    for (const ClMove& move : path.moves) {
        CHECK(move.end.z >= 1.0);
        CHECK(std::abs(move.end.y - 11.0) < 1e-9 || std::abs(move.end.x - 50.0) < 1e-9);
    }
}

TEST(ClPath, AnAllowanceIsLeftAlongTheNormalAndPathsGoOnBesideTheFloor)
{
    constexpr double kAllowance = 0.5;
    constexpr double kMaxGouge = 0.02;
    Tool grown = kBall;
    grown.radius = grown.corner_radius = kBall.radius + kAllowance;
    Tool shrunk = grown;
    shrunk.radius = shrunk.corner_radius = grown.radius - kMaxGouge;
    const std::vector<Surface> level{hill(60.0, 0.0)};
    const DropCutter cutter{level, grown, kAccuracy};
    const DropCutter gouge_cutter{level, shrunk, kAccuracy};
    PathFloor floor{cutter, kAllowance};
    DOUBLES_EQUAL(kAllowance, floor.drop({30.0, 30.0})->z, kAccuracy);
    DOUBLES_EQUAL(0.0, floor.drop({200.0, 30.0})->z, kAccuracy);
    CHECK(!PathFloor{cutter}.drop({200.0, 30.0}));
    const auto clearance = [&](double z) {
        return floor.move_clearance({20.0, 30.0, z}, {40.0, 30.0, z});
    };
    CHECK(clearance(kAllowance) >= 0.0);
    CHECK(clearance(kAllowance - 0.1) < -0.09);
    floor.set_shrunk(gouge_cutter, kMaxGouge);
    CHECK(clearance(kAllowance - kMaxGouge) >= -kMaxGouge);
    CHECK(clearance(kAllowance - 0.1) < -0.09);
}

}  // namespace cusp::test
