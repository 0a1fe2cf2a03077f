// Lengths, counts, times and shapes of tool paths, against closed forms.
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/geometry/toolpath/arc_geometry.hpp"

using namespace cusp;
using namespace cusp::toolpath;

TEST_GROUP(ToolpathMeasure){};

TEST(ToolpathMeasure, SumsLengthsAndCounts)
{
    Toolpath path;
    path.feed = 600;
    path.plunge_feed = 300;
    path.moves = {{MoveKind::kRapid, LineTo{{10, 0, 5}}},
                  {MoveKind::kPlunge, LineTo{{10, 0, 0}}},
                  {MoveKind::kCut, ArcTo{{0, 10, 0}, {0, 0, 0}, ArcPlane::kXY, false}},
                  {MoveKind::kLink, LineTo{{0, 0, 0}}}};
    const PathMeasure sum = measure(path, {0, 0, 5});
    LONGS_EQUAL(1, sum.moves.rapids);
    LONGS_EQUAL(2, sum.moves.lines);
    LONGS_EQUAL(1, sum.moves.arcs);
    DOUBLES_EQUAL(10, sum.rapid_length_mm, 1e-12);
    DOUBLES_EQUAL(5 + 5 * kPi + 10, sum.cut_length_mm, 1e-9);
    DOUBLES_EQUAL(10, sum.link_length_mm, 1e-12);
}

TEST(ToolpathMeasure, LengthsAboveAHeightCountPartsOfMovesAndNoRapids)
{
    Toolpath path;
    path.moves = {{MoveKind::kRapid, LineTo{{0, 0, 5}}},
                  {MoveKind::kPlunge, LineTo{{0, 0, -5}}},
                  {MoveKind::kCut, LineTo{{30, 0, -5}}},
                  {MoveKind::kLink, ArcTo{{30, 10, 5}, {30, 5, 0}, ArcPlane::kXY, false}}};
    const double helix = std::hypot(5 * kPi, 10);
    DOUBLES_EQUAL(2 + 0.2 * helix, cut_length_above(path, {9, 9, 9}, 3), 0.01);
    DOUBLES_EQUAL(0, cut_length_above(path, {9, 9, 9}, 5), 0);
    DOUBLES_EQUAL(40 + helix, cut_length_above(path, {9, 9, 9}, -6), 0.01);
}

TEST(ToolpathMeasure, EstimatesTheTimeFromRestToRest)
{
    Toolpath path;
    path.feed = 3000;  // 50 mm/s
    path.moves = {{MoveKind::kCut, LineTo{{100, 0, 0}}}};
    // ramps of 70 ms each with 1000 mm/s^2 and 50 000 mm/s^3, 1.75 mm long
    DOUBLES_EQUAL(0.14 + 96.5 / 50, measure(path, {0, 0, 0}).estimated_s, 1e-9);
    // never at full speed: 0.25 mm, as long as two ramps up to 9.2 mm/s that reach 679 mm/s^2
    path.moves = {{MoveKind::kCut, LineTo{{0.25, 0, 0}}}};
    const double peak = std::cbrt(0.25 * 0.25 * 0.25 * 50000);
    DOUBLES_EQUAL(4 * std::sqrt(peak / 50000), measure(path, {0, 0, 0}).estimated_s, 1e-9);
}

TEST(ToolpathMeasure, StopsAtCornersOnlyOnTheExactPath)
{
    Toolpath path;
    path.feed = 3000;
    path.moves = {{MoveKind::kCut, LineTo{{50, 0, 0}}}, {MoveKind::kCut, LineTo{{100, 0, 0}}}};
    DOUBLES_EQUAL(0.14 + 96.5 / 50, measure(path, {0, 0, 0}).estimated_s, 1e-9);
    path.moves[1] = {MoveKind::kCut, LineTo{{50, 50, 0}}};
    DOUBLES_EQUAL(2 * (0.14 + 46.5 / 50), measure(path, {0, 0, 0}).estimated_s, 1e-9);
}

TEST(ToolpathMeasure, DescentsGoDownNoFasterThanThePlungeFeed)
{
    Toolpath path;
    path.feed = 1200;
    path.plunge_feed = 300;
    const auto feed = [&](MoveKind kind, Vec3d end) {
        return feed_of(path, {kind, LineTo{end}}, {0, 0, 0});
    };
    DOUBLES_EQUAL(1200, feed(MoveKind::kCut, {0, 0, -5}), 1e-9);
    DOUBLES_EQUAL(300, feed(MoveKind::kPlungingCut, {0, 0, -5}), 1e-9);
    DOUBLES_EQUAL(500, feed(MoveKind::kPlungingCut, {4, 0, -3}), 1e-9);
    DOUBLES_EQUAL(1200, feed(MoveKind::kPlungingCut, {4, 0, 3}), 1e-9);
    DOUBLES_EQUAL(1200, feed(MoveKind::kPlungingCut, {10, 0, -1}), 1e-9);
    // Down by its radius on a half turn.
    const ToolMove helix{MoveKind::kPlungingCut,
                         ArcTo{{-5, 0, -5}, {0, 0, 0}, ArcPlane::kXY, false}};
    DOUBLES_EQUAL(300 * std::hypot(kPi, 1), feed_of(path, helix, {5, 0, 0}), 1e-6);
}

TEST(ToolpathMeasure, HelicesTravelAlongTheirAxis)
{
    const ArcShape arc = arc_shape({5, 0, 0}, {{5, 0, -2}, {0, 0, 0}, ArcPlane::kXY, true});
    DOUBLES_EQUAL(-2 * kPi, arc.sweep, 1e-12);
    DOUBLES_EQUAL(std::hypot(10 * kPi, 2), length(arc), 1e-12);
    DOUBLES_EQUAL(-5, point_on(arc, 0.25).y, 1e-12);
    DOUBLES_EQUAL(-0.5, point_on(arc, 0.25).z, 1e-12);
}

TEST(ToolpathMeasure, ChordsOfArcsStayWithinTheirTolerance)
{
    const ToolMove move{MoveKind::kCut, ArcTo{{0, 10, 0}, {0, 0, 0}, ArcPlane::kXY, false}};
    Vec3d last{10, 0, 0};
    for (const Vec3d p : points_of(move, last, 1e-3)) {
        CHECK(norm(0.5 * (p + last)) >= 10 - 1.0001e-3);
        last = p;
    }
    DOUBLES_EQUAL(10, last.y, 1e-12);
}

TEST_GROUP(ToolProfile){};

TEST(ToolProfile, IsZeroAtTheTipAndTheCornerRadiusAtTheRim)
{
    const Tool ball{1, ToolShape::kBall, 6, 6};
    DOUBLES_EQUAL(0, profile_height(ball, 0), 0);
    DOUBLES_EQUAL(6, profile_height(ball, 6), 1e-12);
    DOUBLES_EQUAL(6 - std::sqrt(27), profile_height(ball, 3), 1e-12);
    const Tool bull{1, ToolShape::kBull, 6, 2};
    DOUBLES_EQUAL(0, profile_height(bull, 4), 0);
    DOUBLES_EQUAL(2, profile_height(bull, 6), 1e-12);
    const Tool flat{1, ToolShape::kFlat, 6, 0};
    DOUBLES_EQUAL(0, profile_height(flat, 6), 0);
    CHECK(std::isinf(profile_height(flat, 6.001)));
}
