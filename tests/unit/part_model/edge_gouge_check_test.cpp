// Moves of a ball past the rim of a level plate, compared with what they remove from it in plan.
#include "host_tools/geometry/part_model/edge_gouge_check.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::part_model;

namespace {

constexpr double kRadius = 2;
constexpr double kDeepest = 0.005;
constexpr double kBand = 0.0045;
constexpr double kPieces = 5e-5;  // radii: error of edges as polylines

// 10 by 10 mm, its upper side at z = 0.
Surface plate()
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.points = {{0, 0, 0}, {0, 10, 0}, {10, 0, 0}, {10, 10, 0}};
    s.weights.assign(4, 1.0);
    return s;
}

// Depth of a ball with its tip at `tip` below the rim x = 0.
double below_rim(Vec3d tip)
{
    const double square = kRadius * kRadius - tip.x * tip.x;
    return square > 0 ? std::sqrt(square) - kRadius - tip.z : -1;
}

}  // namespace

TEST_GROUP(EdgeGougeCheck){};

TEST(EdgeGougeCheck, MovesTheBallThatPassesTheRimFromBeside)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    for (const double beside : {0.3, 1.0, 1.7, 1.95}) {
        // A gouge of half the tolerance along the ball's normal removes far more of the plate.
        const double centre = std::sqrt(std::pow(kRadius - kDeepest, 2) - beside * beside);
        const Vec3d from{-beside, 1, centre - kRadius};
        const Vec3d to{-beside, 9, centre - kRadius};
        CHECK(!guard.clears(from, to));
        for (const Vec3d& tip : guard.moved_clear({from, to}, kBand)) {
            CHECK(below_rim(tip - Vec3d{0, 0, kBand}) <= kDeepest + 1e-6);
        }
    }
}

TEST(EdgeGougeCheck, LeavesTheBallThatMeetsTheFaceSquare)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    const std::vector<Vec3d> over{{0, 1, 0}, {0, 9, 0}, {5, 9, 0}};
    CHECK(guard.moved_clear(over, kBand) == over);
    CHECK(guard.clears({0, 1, -kBand}, {0, 9, -kBand}));
}

TEST(EdgeGougeCheck, FindsTheRimBetweenTwoFarPlaces)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    const std::vector<Vec3d> way{{-4, 5, -1.2}, {-1, 5, -0.3}};
    const std::vector<Vec3d> kept = guard.moved_clear(way, kBand);
    CHECK(kept.size() > way.size());
    for (const Vec3d& tip : kept) {
        CHECK(below_rim(tip) <= kDeepest);
    }
}

// The ball's centre is below the plate; its shank passes the rim.
TEST(EdgeGougeCheck, KeepsTheShankOffARimOverTheBall)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    for (const double in : {1e-4, 0.5 * kDeepest, 0.9 * kDeepest}) {
        for (const double tip : {-2.5, -4.0}) {
            const Vec3d from{in - kRadius, 1, tip};
            const Vec3d to{in - kRadius, 9, tip};
            CHECK(!guard.clears(from, to));
            for (const Vec3d& kept : guard.moved_clear({from, to}, kBand)) {
                CHECK(kept.x <= -kRadius - 0.99 * kBand);
                DOUBLES_EQUAL(tip, kept.z, 1e-9);
            }
            CHECK(guard.raised_clear(from, kBand).tip.z + kRadius > 0);
        }
    }
}

TEST(EdgeGougeCheck, RaisesTheBallBesideTheRimUntilItNeedsNoPush)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    for (const double beside : {0.3, 1.0, 1.95, 1.999, 2.001}) {
        const double dip = std::max(0.0, std::pow(kRadius - kDeepest, 2) - beside * beside);
        const Vec3d tip{-beside, 5, std::sqrt(dip) - kRadius};
        const Vec3d raised = guard.raised_clear(tip, kBand).tip;
        CHECK(raised.x == tip.x && raised.y == tip.y && raised.z >= tip.z);
        DOUBLES_EQUAL(0, norm(guard.moved_clear({raised}, kBand).front() - raised), 1e-6);
        // No higher than necessary.
        if (raised.z > tip.z) {
            CHECK(norm(guard.moved_clear({raised - Vec3d{0, 0, 1e-4}}, kBand).front() -
                       (raised - Vec3d{0, 0, 1e-4})) > 0);
        }
    }
    const Vec3d over{1, 5, 0};
    CHECK(guard.raised_clear(over, kBand).tip == over);
}

TEST(EdgeGougeCheck, KeepsTheBallOutOfTheBarrierThatRaisedIt)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    for (const double beside : {0.3, 1.0, 1.95}) {
        const EdgeGougeCheck::RaisedTip raised = guard.raised_clear({-beside, 5, -kRadius}, kBand);
        CHECK(raised.barrier.has_value());
        const Vec3d middle = raised.tip + Vec3d{0, 0, kRadius};
        DOUBLES_EQUAL(kRadius, norm(middle - *raised.barrier), 1e-9);
        for (int k = 0; k < 64; ++k) {
            const Vec3d out{std::cos(0.7 * k), std::sin(0.7 * k), std::cos(0.4 * k)};
            const Vec3d inside = *raised.barrier + out * ((kRadius - 1e-6) / norm(out));
            const Vec3d tip = inside - Vec3d{0, 0, kRadius};
            CHECK(guard.raised_clear(tip, kBand).barrier.has_value());
        }
    }
    CHECK(!guard.raised_clear({1, 5, 0}, kBand).barrier.has_value());
}

TEST(EdgeGougeCheck, TellsHowDeepAMoveCutsIntoTheRim)
{
    const EdgeGougeCheck guard{{plate()}, kRadius, kDeepest};
    for (const double beside : {0.3, 1.0, 1.7, 1.95}) {
        const double centre = std::sqrt(std::pow(kRadius - kDeepest, 2) - beside * beside);
        const double up = centre / kRadius;
        const Vec3d from{-beside, 1, centre - kRadius};
        const Vec3d to{-beside, 90, centre - kRadius};
        // Up to the rim and back, deepest where it is nearest.
        const Vec3d far{-9, 4, from.z};
        for (const double cut :
             {guard.cut(from, to, 0), guard.cut(from, from, 0), guard.cut(far, from, 0)}) {
            CHECK(cut >= below_rim(from) && cut <= below_rim(from) + 1.1 * kPieces * kRadius / up);
        }
    }
    DOUBLES_EQUAL(0, guard.cut({-1, 1, 0}, {-1, 9, 0}, 0), 0.0);
    DOUBLES_EQUAL(kBand, guard.cut({0, 1, -kBand}, {0, 9, -kBand}, 0), 1.1 * kPieces * kRadius);
}

TEST(EdgeGougeCheck, KeepsOffTheEdgeOfATrimButNotOffWhatIsTrimmedAway)
{
    Surface half = plate();
    const auto side = [](Vec3d a, Vec3d b) {
        return Curve{1, {0, 0, 1, 1}, {a, b}, {1, 1}};
    };
    half.trims = {{side({0.5, 0, 0}, {1, 0, 0}), side({1, 0, 0}, {1, 1, 0}),
                   side({1, 1, 0}, {0.5, 1, 0}), side({0.5, 1, 0}, {0.5, 0, 0})}};
    const EdgeGougeCheck guard{{half}, kRadius, kDeepest};
    const double beside = 1.0;
    const double depth = std::sqrt(std::pow(kRadius - kDeepest, 2) - beside * beside) - kRadius;
    const Vec3d cut{0, 0, below_rim({-beside, 5, depth})};
    DOUBLES_EQUAL(cut.z, guard.cut({5 - beside, 1, depth}, {5 - beside, 9, depth}, 0),
                  0.2 * kDeepest);
    DOUBLES_EQUAL(0, guard.cut({-beside, 1, depth}, {-beside, 9, depth}, 0), 0.0);
}
