// Clearance and drop over planes, cylinders and dense samples, with known results.
#include "host_tools/geometry/part_model/part_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include "CppUTest/TestHarness.h"

#include "tests/support/holed_sheet.hpp"
#include "tests/support/three_tools.hpp"

using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

// Over [0, 20] x [0, 20]: z = slope * x.
Surface plane(double slope)
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.size_u = s.size_v = 2;
    s.points = {{0, 0, 0}, {0, 20, 0}, {20, 0, 20 * slope}, {20, 20, 20 * slope}};
    s.weights = {1, 1, 1, 1};
    return s;
}

// A quarter of a cylinder of radius 10 along y, from (10, 0) over the top to (0, 10): rational.
Surface quarter_cylinder()
{
    Surface s;
    s.degree_u = 2;
    s.degree_v = 1;
    s.knots_u = {0, 0, 0, 1, 1, 1};
    s.knots_v = {0, 0, 1, 1};
    s.size_u = 3;
    s.size_v = 2;
    s.points = {{10, 0, 0}, {10, 30, 0}, {10, 0, 10}, {10, 30, 10}, {0, 0, 10}, {0, 30, 10}};
    const double w = std::sqrt(0.5);
    s.weights = {1, 1, w, w, 1, 1};
    return s;
}

Surface random_surface(std::mt19937& random)
{
    std::uniform_real_distribution<double> height{-6, 6};
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
    s.size_u = s.size_v = 6;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            s.points.push_back({8.0 * i, 8.0 * j, height(random)});
        }
    }
    s.weights.assign(36, 1.0);
    return s;
}

Curve side(Vec3d a, Vec3d b) { return {1, {0, 0, 1, 1}, {a, b}, {1, 1}}; }

Surface holed_plane()
{
    Surface s = plane(0);
    s.trims = {{side({0, 0, 0}, {1, 0, 0}), side({1, 0, 0}, {1, 1, 0}), side({1, 1, 0}, {0, 1, 0}),
                side({0, 1, 0}, {0, 0, 0})},
               {side({.25, .25, 0}, {.25, .75, 0}), side({.25, .75, 0}, {.75, .75, 0}),
                side({.75, .75, 0}, {.75, .25, 0}), side({.75, .25, 0}, {.25, .25, 0})}};
    return s;
}

double dense_distance(const PartModel& model, Vec3d centre)
{
    double least = 1e9;
    for (int i = 0; i <= 300; ++i) {
        for (int j = 0; j <= 300; ++j) {
            const Vec3d p = model.evaluate(0, 0.01 * i, 0.01 * j).point;
            const Vec3d r{p.x - centre.x, p.y - centre.y, std::min(0.0, p.z - centre.z)};
            least = std::min(least, norm(r));
        }
    }
    return least;
}

}  // namespace

TEST_GROUP(PartModelDistance){};

TEST(PartModelDistance, OfABallFromASlopeIsThatOfItsCentre)
{
    const PartModel model{{plane(1)}};
    const double gap = 5 / std::sqrt(2.0) - 3;
    DOUBLES_EQUAL(gap, model.distance(kBall, {10, 10, 15 - 3.0}, 10).distance, 1e-6);
}

TEST(PartModelDistance, EndsAtTheLimit)
{
    const PartModel model{{plane(0)}};
    DOUBLES_EQUAL(0.5, model.distance(kBall, {10, 10, 4}, 0.5).distance, 0);
}

TEST(PartModelDistance, SeesASurfaceOverTheTool)
{
    const PartModel model{{plane(0)}};
    CHECK(model.distance(kBall, {10, 10, -20}, 1).distance < -2.9);
}

TEST(PartModelDistance, IsExactOnARationalCylinder)
{
    const PartModel model{{quarter_cylinder()}};
    const double side_length = 14 / std::sqrt(2.0);
    const ToolDistance c = model.distance(kBall, {side_length, 12, side_length - 3}, 10);
    DOUBLES_EQUAL(1, c.distance, 1e-6);
    DOUBLES_EQUAL(10 / std::sqrt(2.0), c.nearest.point.x, 1e-3);
}

TEST(PartModelDistance, AgreesWithDenseSamplesOnRandomSurfaces)
{
    constexpr unsigned kSeed = 7;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> at{0, 40};
    for (int turn = 0; turn < 6; ++turn) {
        const PartModel model{{random_surface(random)}};
        const Vec3d tip{at(random), at(random), at(random) * 0.2};
        const double dense = dense_distance(model, tip + Vec3d{0, 0, 3});
        const double exact = model.distance(kBall, tip, 100).distance + 3;
        CHECK(exact <= dense + 1e-9);
        CHECK(exact >= dense - 0.15);
    }
}

// Results between the two limits are accurate within the resolution; below and above, only the side
// is known.
TEST(PartModelDistance, WithinBoundsIsTheExactOneLessTheSlack)
{
    constexpr unsigned kSeed = 8;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> at{0, 40};
    std::uniform_real_distribution<double> share{0, 1};
    for (int turn = 0; turn < 300; ++turn) {
        const PartModel model{{random_surface(random)}};
        const double corner = 1.5 * (turn % 3);
        const Tool tool{1, ToolShape::kBull, 3, corner};
        const Vec3d tip{at(random), at(random), at(random) * 0.3};
        const double exact = model.distance(tool, tip, 100).distance;
        const double least = 2 * share(random) - corner;
        const double most = least + 4 * share(random);
        const double slack = 0.1 * share(random);
        const double found = model.distance_within(tool, tip, {least, most, slack});
        constexpr double kExact = 2e-5;  // of a disc
        CHECK(found <= most + 1e-12);
        if (found > least) {
            CHECK(found <= exact + kExact);
            CHECK(found >= std::min(most, exact) - slack - kExact);
        } else {
            CHECK(exact <= least + slack + kExact);
        }
        model.forget_cells();
        DOUBLES_EQUAL(exact, model.distance(tool, tip, 100).distance, kExact);
    }
}

TEST(PartModelDistance, PassesThroughATrimmedHole)
{
    const PartModel model{{holed_plane()}};
    const double to_edge = std::sqrt(5.0 * 5.0 + 1.0) - 3;
    DOUBLES_EQUAL(to_edge, model.distance(kBall, {10, 10, 1 - 3.0}, 10).distance, 2e-4);
    DOUBLES_EQUAL(-2, model.distance(kBall, {2, 2, 1 - 3.0}, 10).distance, 1e-6);
}

// Below the hole's rim and above it, near the middle too, where all of the rim is about equally
// far.
TEST(PartModelDistance, AgreesWithDenseSamplesRoundATrimmedHole)
{
    constexpr unsigned kSeed = 5;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    const PartModel model{{holed_sheet(0.2)}};
    std::vector<Vec3d> samples;
    constexpr int kSamples = 400;
    for (int i = 0; i <= kSamples; ++i) {
        for (int j = 0; j <= kSamples; ++j) {
            const double u = static_cast<double>(i) / kSamples;
            const double v = static_cast<double>(j) / kSamples;
            if (std::hypot(u - 0.5, v - 0.5) >= 0.2) {
                samples.push_back(model.evaluate(0, u, v).point);
            }
        }
    }
    for (int k = 0; k < 10 * kSamples; ++k) {
        samples.push_back(
            model.evaluate(0, 0.5 + 0.2 * std::cos(k), 0.5 + 0.2 * std::sin(k)).point);
    }
    constexpr double kApart = 0.12;
    for (int turn = 0; turn < 120; ++turn) {
        const Tool& tool = turn % 3 == 0 ? kFlat : turn % 3 == 1 ? kBull : kBall;
        const double round = turn % 2 == 0 ? 0.2 : 6;
        std::uniform_real_distribution<double> at{15 - round, 15 + round};
        std::uniform_real_distribution<double> height{-2, 7};
        const Vec3d tip{at(random), at(random), height(random)};
        double dense = 1e9;
        for (const Vec3d& p : samples) {
            const double out = std::max(
                0.0, std::hypot(p.x - tip.x, p.y - tip.y) - tool.radius + tool.corner_radius);
            const double down = std::min(0.0, p.z - tip.z - tool.corner_radius);
            dense = std::min(dense, std::hypot(out, down) - tool.corner_radius);
        }
        const double exact = model.distance(tool, tip, 100).distance;
        CHECK(exact <= dense + 1e-4);
        CHECK(exact >= dense - kApart);
    }
}

TEST(PartModelDistance, AlongAMoveIsBoundedFromBelow)
{
    const PartModel model{{plane(0)}};
    // Descends from 1 mm above the plane to 1 mm below it.
    const double bound = model.move_clearance(kBall, {5, 5, 1}, {9, 5, -1}, 0, 1e-4);
    CHECK(bound <= -1 + 1e-9);
    CHECK(bound >= -1 - 1e-3);
    DOUBLES_EQUAL(0, model.move_clearance(kBall, {5, 5, 0.01}, {9, 5, 0.01}, 0, 1e-4), 1e-12);
}

TEST(PartModelDistance, OfARollingBallIsBoundedFromBelowOnRandomSurfaces)
{
    constexpr unsigned kSeed = 19;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> place{0.05, 2.95};
    std::uniform_real_distribution<double> step{-0.15, 0.15};
    int proved = 0;
    for (const double steep : {1.0, 1.0, 2.0, 4.0}) {
        Surface surface = random_surface(random);
        for (Vec3d& p : surface.points) {
            p.z *= steep;
        }
        const PartModel model{{surface}};
        for (const double radius : {1.0, 3.0}) {
            const Tool ball{1, ToolShape::kBall, radius, radius};
            for (int k = 0; k < 40; ++k) {
                const double u = place(random);
                const double v = place(random);
                const CcPoint a = model.cc_point(0, u, v, radius + 0.003);
                const CcPoint b =
                    model.cc_point(0, std::clamp(u + step(random), 0.0, 3.0),
                                   std::clamp(v + step(random), 0.0, 3.0), radius + 0.003);
                const std::optional<double> bound =
                    model.move_clearance_between_contacts(a, b, radius, -0.05);
                if (!bound) {
                    continue;
                }
                ++proved;
                CHECK(*bound >= -0.05);
                for (int at = 0; at <= 16; ++at) {
                    Vec3d tip = a.centre() + (b.centre() - a.centre()) * (at / 16.0);
                    tip.z -= radius;
                    CHECK(model.distance(ball, tip, 1).distance >= *bound - 1e-6);
                }
            }
        }
    }
    std::printf("%d proved ", proved);
    CHECK(proved > 60);
}

TEST(PartModelDistance, OfARollingBallIsNotProvedWhereItCutsAnotherPlace)
{
    // A slot narrower than the ball: two planes that meet in a valley.
    Surface left = plane(-1);
    Surface right = plane(1);
    for (Vec3d& p : right.points) {
        p.x += 20;
        p.z -= 20;
    }
    const PartModel model{{left, right}};
    const CcPoint deep = model.cc_point(0, 0.95, 0.5, 3);
    const CcPoint high = model.cc_point(0, 0.3, 0.5, 3);
    CHECK(!model.move_clearance_between_contacts(deep, deep, 3, 0));
    CHECK(!model.move_clearance_between_contacts(high, deep, 3, 0));
    CHECK(model.move_clearance_between_contacts(high, high, 3, -1e-9).has_value());
}

// The model's data of the last contacts refers to cells, which are released.
TEST(PartModelDistance, OfAMoveBetweenContactsIsTheSameAfterCellsAreForgotten)
{
    const PartModel model{{plane(1)}};
    const CcPoint a = model.cc_point(0, 0.3, 0.5, 3);
    const CcPoint b = model.cc_point(0, 0.35, 0.5, 3);
    const std::optional<double> before = model.move_clearance_between_contacts(a, b, 3, -0.05);
    CHECK(before.has_value());
    model.forget_cells();
    const std::optional<double> after = model.move_clearance_between_contacts(a, b, 3, -0.05);
    CHECK(before == after);
}

TEST_GROUP(PartModelDrop){};

TEST(PartModelDrop, OfABallOnASlopeTouchesBesideTheAxis)
{
    const PartModel model{{plane(1)}};
    DOUBLES_EQUAL(10 + 3 * std::sqrt(2.0) - 3, *model.drop_height(kBall, 10, 10), 1e-6);
}

TEST(PartModelDrop, OfAFlatToolTouchesWithItsRim)
{
    const PartModel model{{plane(1)}};
    DOUBLES_EQUAL(13, *model.drop_height(kFlat, 10, 10), 1e-4);
}

TEST(PartModelDrop, OfABullToolTouchesWithItsCorner)
{
    const PartModel model{{plane(1)}};
    DOUBLES_EQUAL(10 + 2 + std::sqrt(2.0) - 1, *model.drop_height(kBull, 10, 10), 1e-4);
}

TEST(PartModelDrop, HighestPlaceIsOfTheSurfaceNotOfItsControlPoints)
{
    const PartModel round{{quarter_cylinder(), plane(0.2)}};
    DOUBLES_EQUAL(10, round.highest(), 1e-5);
    std::mt19937 random{5};
    const PartModel wavy{{random_surface(random)}};
    double dense = -1e9;
    for (int i = 0; i <= 600; ++i) {
        for (int j = 0; j <= 600; ++j) {
            dense = std::max(dense, wavy.evaluate(0, 0.005 * i, 0.005 * j).point.z);
        }
    }
    DOUBLES_EQUAL(dense, wavy.highest(), 1e-3);
    CHECK(wavy.highest() >= dense - 1e-5);
    CHECK(wavy.box_high().z > dense + 0.5);
}

TEST(PartModelDrop, HighestPlaceIsNotOfWhatIsTrimmedAway)
{
    Surface slope = plane(1);
    slope.trims = {{side({0, 0, 0}, {.5, 0, 0}), side({.5, 0, 0}, {.5, 1, 0}),
                    side({.5, 1, 0}, {0, 1, 0}), side({0, 1, 0}, {0, 0, 0})}};
    DOUBLES_EQUAL(10, PartModel{{slope}}.highest(), 1e-3);
}

TEST(PartModelDrop, MissesBesideTheModel)
{
    const PartModel model{{plane(0)}};
    CHECK_FALSE(model.drop_height(kBall, 30, 10).has_value());
}

// From above, the tool is hardly off the upper plane's rim all along.
TEST(PartModelDrop, PassesAnUprightRimThatItHardlyMisses)
{
    Surface upper = plane(0);
    for (Vec3d& p : upper.points) {
        p.z = 9;
    }
    Surface lower = plane(0);
    for (Vec3d& p : lower.points) {
        p.x += 15;
    }
    const PartModel model{{lower, upper}};
    for (const double off : {1e-5, 1e-3, 4e-3, 0.02, 0.3}) {
        for (const Tool& tool : {kBall, kBull}) {
            const auto z = model.drop_height(tool, 20 + tool.radius + off, 10);
            CHECK(z.has_value());
            DOUBLES_EQUAL(0, *z, 1e-4);
            CHECK(model.distance(tool, {20 + tool.radius + off, 10, *z}, 1).distance > -1e-8);
        }
    }
}

TEST(PartModelDrop, LeavesTheToolInContact)
{
    constexpr unsigned kSeed = 11;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> at{-2, 42};
    for (int turn = 0; turn < 5; ++turn) {
        const PartModel model{{random_surface(random), plane(0)}};
        for (int k = 0; k < 20; ++k) {
            const double x = at(random);
            const double y = at(random);
            const auto z = model.drop_height(kBall, x, y);
            CHECK(z.has_value());
            const double gap = model.distance(kBall, {x, y, *z}, 1).distance;
            CHECK(gap >= -1e-7 && gap <= 1e-6);
        }
    }
}

TEST(PartModelDrop, OnATrimmedEdgeIsInContactWithAllThatTheEdgeMayBeOff)
{
    const PartModel model{{holed_sheet(0.3), plane(0)}};
    for (int k = 0; k < 200; ++k) {
        const double turn = 0.0314 * k;
        const double away = 5.5 + 0.02 * k;
        const double x = 15 + away * std::cos(turn);
        const double y = 15 + away * std::sin(turn);
        const auto rest = model.drop_cutter(kBall, x, y);
        CHECK(rest.has_value());
        const double gap = model.distance(kBall, {x, y, rest->tip}, 1).distance;
        CHECK(gap >= -1e-7 && gap <= 1e-6);
    }
}

TEST(PartModelDrop, RestsWhereTheContactUnderItsCentreIs)
{
    std::mt19937 random{13};
    const PartModel model{{random_surface(random)}};
    std::uniform_real_distribution<double> at{6, 34};
    int seen = 0;
    for (int k = 0; k < 100; ++k) {
        const double x = at(random);
        const double y = at(random);
        const auto rest = model.drop_cutter(kBall, x, y);
        const auto under = model.cc_point_under(
            x, y, rest->place.surface, {rest->place.u + 0.01, rest->place.v - 0.01}, kBall.radius);
        if (!under) {
            continue;
        }
        DOUBLES_EQUAL(x, under->centre().x, 1e-9);
        DOUBLES_EQUAL(y, under->centre().y, 1e-9);
        CHECK(under->centre().z - kBall.radius <= rest->tip + 1e-5);
        seen += under->centre().z - kBall.radius > rest->tip - 1e-5 ? 1 : 0;
    }
    CHECK(seen > 60);
}

TEST(PartModelDistance, ContactOnARimWithALevelNormalIsOutside)
{
    const PartModel model{{quarter_cylinder()}};
    DOUBLES_EQUAL(1, model.cc_point(0, 0.0, 0.3, 3).normal.x, 1e-9);
    Surface other = quarter_cylinder();
    for (Vec3d& p : other.points) {
        p.x = -p.x;
    }
    DOUBLES_EQUAL(-1, PartModel{{other}}.cc_point(0, 0.0, 0.3, 3).normal.x, 1e-9);
}
