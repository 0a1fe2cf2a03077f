#include "firmware/machine/travel.hpp"

#include <optional>
#include <variant>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::machine;

namespace {

constexpr std::int64_t kMillimetre = 1000000;

path::Move arc_from_minus_ten(bool clockwise, std::int64_t end_x, std::int64_t end_y)
{
    path::Move move;
    move.start = {-10 * kMillimetre, -50 * kMillimetre, -5 * kMillimetre};
    move.end = {end_x * kMillimetre, end_y * kMillimetre, -5 * kMillimetre};
    path::ArcWords words{};
    words.start = move.start;
    words.end = move.end;
    words.plane = path::Plane::kXY;
    words.clockwise = clockwise;
    words.second_offset_nm = 10 * kMillimetre;
    words.turns = 1;
    const auto arc = path::make_arc(words);
    CHECK(static_cast<bool>(arc));
    move.path = *arc;
    return move;
}

}  // namespace

TEST_GROUP(Travel) { Settings settings; };

TEST(Travel, OfALineEndsAtItsEnds)
{
    path::Move move;
    move.end = {-300 * kMillimetre, 0, 0};
    CHECK(within_travel(move, settings));
    move.end.x -= 100;
    CHECK_FALSE(within_travel(move, settings));
    move.end = {0, 0, 100};
    CHECK_FALSE(within_travel(move, settings));
}

TEST(Travel, OfAnArcReachesToItsTurns)
{
    // From (-10, -50) around (-10, -40): counter-clockwise through (0, -40), and not beyond.
    const Extent extent = extent_of(arc_from_minus_ten(false, -10, -30));
    CHECK(extent.most.x >= -2 && extent.most.x <= 2);
    LONGS_EQUAL(-10 * kMillimetre, extent.least.x);
    CHECK(within_travel(arc_from_minus_ten(false, -10, -30), settings));
    const Extent whole = extent_of(arc_from_minus_ten(true, -10, -50));
    CHECK(whole.least.x >= -20 * kMillimetre - 2 && whole.least.x <= -20 * kMillimetre + 2);
    CHECK(whole.most.y >= -30 * kMillimetre - 2 && whole.most.y <= -30 * kMillimetre + 2);
}

TEST(Travel, OfACurveIsThatOfItsControlPoints)
{
    path::Move move;
    move.start = {-kMillimetre, -kMillimetre, -kMillimetre};
    move.end = move.start;
    path::BezierPiece piece{};
    piece.order = 3;
    piece.points[1] = {2.0F, 0.0F, 0.0F};
    move.path = piece;
    LONGS_EQUAL(kMillimetre, extent_of(move).most.x);
    CHECK_FALSE(within_travel(move, settings));
}

// Beyond the travel by 5 mm in X and above it by 1 mm in Z.
TEST(Travel, LetsALineComeBackAndGoNoFurtherOut)
{
    struct Way {
        double x, y, z;
        bool passes;
    };
    constexpr Way kWays[] = {
        {-1, 0, 0, true},                          // into the travel
        {2, -5, 1, true},                          // towards it
        {5, -5, 0, true},                          // in again on one axis
        {5, -40, 1, true},                         // no further out
        {5.1, 0, 0, false},                        // further out
        {-1, 0, 1.1, false}, {-301, 0, 0, false},  // out at the other end
        {2, 1, 0, false},                          // out on an axis that was in
    };
    path::Move move;
    move.start = {5 * kMillimetre, -kMillimetre, kMillimetre};
    for (const Way& way : kWays) {
        move.end = to_position({way.x, way.y, way.z});
        CHECK(may_travel(move, settings) == way.passes);
        CHECK(within_travel(move, settings) == false);
    }
    move.path = std::get<path::Arc>(arc_from_minus_ten(false, -10, -30).path);
    CHECK_FALSE(may_travel(move, settings));
}
