#include "host_tools/geometry/part_model/trim_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/loops.hpp"
#include "tests/support/plates.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace nurbs;
using namespace part_model;

namespace {

constexpr double kSide = 20.0;  // mm
constexpr double kTrimEdgeError = 1e-3;
constexpr int kLooks = 5000;

Curve circle_about(Vec2d centre, double radius)
{
    const double w = std::sqrt(0.5);
    const double corners[][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                 {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    Curve circle{2, {0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0}, {}, {}};
    for (int i = 0; i < 9; ++i) {
        circle.points.push_back(
            {centre.x + radius * corners[i][0], centre.y + radius * corners[i][1], 0.0});
        circle.weights.push_back(i % 2 == 0 ? 1.0 : w);
    }
    return circle;
}

// Bent both ways, counter-clockwise, with a corner where it closes.
Curve wave_about(Vec2d centre, double radius)
{
    constexpr int kPoints = 14;
    Curve wave;
    wave.degree = 3;
    wave.knots.assign(4, 0.0);
    for (int i = 1; i < kPoints - 3; ++i) {
        wave.knots.push_back(i);
    }
    wave.knots.insert(wave.knots.end(), 4, kPoints - 3.0);
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 6.283185307179586 * i / (kPoints - 1);
        const double out = radius * (i % 2 == 0 ? 1.0 : 0.6);
        wave.points.push_back(
            {centre.x + out * std::cos(angle), centre.y + out * std::sin(angle), 0.0});
        wave.weights.push_back(i % 3 == 0 ? 1.5 : 1.0);
    }
    wave.points.back() = wave.points.front();
    wave.weights.back() = wave.weights.front();
    return wave;
}

// Bent up across v, so that lines along v are bent in space.
Surface bent_sheet()
{
    Surface s = turned_plate({0.0, 0.0}, {1.0, 0.0}, kSide, kSide, 0.0);
    s.degree_v = 2;
    s.size_v = 3;
    s.knots_v = {0.0, 0.0, 0.0, 1.0, 1.0, 1.0};
    s.points.clear();
    for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.0, 0.5}) {
            s.points.push_back({kSide * x, kSide * y, y == 0.0 ? 6.0 : 0.0});
        }
    }
    s.weights.assign(6, 1.0);
    return s;
}

TEST_GROUP(TrimRegion){
    // A point of each curve, and a direction to its left.
    template <class Check>
    void along_edges(const Surface& surface, const Check& check){for (const std::vector<Curve>& loop
                                                                      : surface.trims){
        for (const Curve& curve
             : loop){for (int i = 1; i < kLooks; ++i){const double share = (i + 0.123) / kLooks;
const double t = curve.domain_begin() + (curve.domain_end() - curve.domain_begin()) * share;
const CurvePoint p = derivatives_at(curve, t);
const Vec2d left{-p.first.y, p.first.x};
check(in_plan(p.point), left*(1.0 / norm(left)));
}  // namespace
}  // namespace cusp::test
}
}

// All points kept by the loops are inside, and little more.
void check_region(const Surface& surface)
{
    const TrimRegion region{surface, kTrimEdgeError};
    along_edges(surface, [&](Vec2d at, Vec2d left) {
        constexpr double kBeside = 1e-9;
        const Vec2d inside = at + left * kBeside;
        const Vec2d outside = at - left * (1.5 * kTrimEdgeError / kSide);
        CHECK(region.inside(inside.x, inside.y));
        CHECK(!region.inside(outside.x, outside.y));
        CHECK(region.part(inside.x - kBeside, inside.x + kBeside, inside.y - kBeside,
                          inside.y + kBeside) != TrimRegion::Part::kOutside);
    });
}
}
;

TEST(TrimRegion, CutsNothingOffACircle)
{
    Surface surface = bent_sheet();
    surface.trims = {{circle_about({0.5, 0.5}, 0.4)}};
    check_region(surface);
}

TEST(TrimRegion, CutsNothingOffBesideAHole)
{
    Surface surface = bent_sheet();
    surface.trims = {{circle_about({0.5, 0.5}, 0.45)}, {reversed(circle_about({0.4, 0.5}, 0.2))}};
    check_region(surface);
}

TEST(TrimRegion, CutsNothingOffAnEdgeBentBothWays)
{
    Surface surface = bent_sheet();
    surface.trims = {{wave_about({0.5, 0.5}, 0.48)}, {reversed(wave_about({0.5, 0.5}, 0.2))}};
    check_region(surface);
}

TEST(TrimRegion, LeavesARemnantThatHoldsWhatIsInside)
{
    Surface surface = bent_sheet();
    surface.trims = {{circle_about({0.5, 0.5}, 0.45)}, {reversed(circle_about({0.4, 0.5}, 0.2))}};
    const TrimRegion region{surface, kTrimEdgeError};
    TrimRegion::Remnant left;
    constexpr int kCells = 23;
    std::array<int, 3> count{};
    for (int i = 0; i < kCells * kCells; ++i) {
        const Vec2d low{static_cast<double>(i / kCells) / kCells,
                        static_cast<double>(i % kCells) / kCells};
        const Vec2d high = low + Vec2d{1.0 / kCells, 1.0 / kCells};
        const TrimRegion::Part part = region.remnant(low.x, high.x, low.y, high.y, left);
        CHECK(part == region.part(low.x, high.x, low.y, high.y));
        CHECK_EQUAL(part == TrimRegion::Part::kCut, !left.edge.empty());
        ++count[part == TrimRegion::Part::kCut ? 0 : part == TrimRegion::Part::kInside ? 1 : 2];
        std::vector<Vec2d> corners;
        for (const Vec2d at : {low, Vec2d{low.x, high.y}, Vec2d{high.x, low.y}, high}) {
            if (part == TrimRegion::Part::kCut && region.inside(at.x, at.y)) {
                corners.push_back(at);
            } else {
                CHECK_EQUAL(part == TrimRegion::Part::kInside, region.inside(at.x, at.y));
            }
        }
        LONGS_EQUAL(corners.size(), left.corners.size());
        for (std::size_t k = 0; k < corners.size(); ++k) {
            CHECK(corners[k].x == left.corners[k].x && corners[k].y == left.corners[k].y);
        }
    }
    CHECK(count[0] > 50 && count[1] > 50 && count[2] > 50);
}

// Slivers of any width are met by every rectangle that they cross, and by no other.
TEST(TrimRegion, FindsAPlaceBesideTrims)
{
    Surface surface = turned_plate({0.0, 0.0}, {1.0, 0.0}, kSide, kSide, 0.0);
    for (double wide = 0.1; wide > 1e-7; wide *= 0.1) {
        surface.trims = {{loop_of({{0.1, 0.1}, {0.1 + wide, 0.1}, {0.9 + wide, 0.9}, {0.9, 0.9}})}};
        const TrimRegion region{surface, kTrimEdgeError};
        int count = 0;
        for (int i = 0; i < 100; ++i) {
            const Vec2d low{0.1 * (i / 10) + 0.01, 0.1 * (i % 10) + 0.02};
            const Vec2d high = low + Vec2d{0.1, 0.1};
            const auto beside = region.beside(low, high);
            // One that an edge touches at a corner holds no place.
            CHECK(!beside || region.part(low.x, high.x, low.y, high.y) == TrimRegion::Part::kCut);
            if (beside) {
                ++count;
                CHECK(region.inside(beside->place.x, beside->place.y));
                CHECK(beside->place.x >= low.x && beside->place.x <= high.x);
                CHECK(beside->place.y >= low.y && beside->place.y <= high.y);
                CHECK(norm(beside->along) > 0);
            }
        }
        CHECK(count >= 16);
    }
}

// A band whose long sides are waves so flat that hundreds of polyline sides share a few rows.
Curve flat_band()
{
    constexpr int kPoints = 200;
    Curve band;
    band.degree = 1;
    for (int i = 0; i < 2 * kPoints; ++i) {
        const double share = static_cast<double>(i % kPoints) / (kPoints - 1);
        const double wave = 2e-3 * std::sin(40 * share);
        band.points.push_back(i < kPoints ? Vec3d{0.1 + 0.8 * share, 0.3 + wave, 0}
                                          : Vec3d{0.9 - 0.8 * share, 0.7 + wave, 0});
    }
    band.points.push_back(band.points.front());
    const std::size_t count = band.points.size();
    band.weights.assign(count, 1.0);
    band.knots.push_back(0);
    for (std::size_t i = 0; i < count; ++i) {
        band.knots.push_back(static_cast<double>(i));
    }
    band.knots.push_back(static_cast<double>(count - 1));
    return band;
}

bool is_inside_loops(const TrimRegion& region, Vec2d at)
{
    bool in = false;
    for (const std::vector<Vec2d>& loop : region.loops()) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2d a = loop[k];
            const Vec2d b = loop[(k + 1) % loop.size()];
            if ((a.y > at.y) != (b.y > at.y) &&
                at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)) {
                in = !in;
            }
        }
    }
    return in;
}

TEST(TrimRegion, AnswersByItsLoopsWhereManySidesShareARow)
{
    Surface surface = turned_plate({0.0, 0.0}, {1.0, 0.0}, kSide, kSide, 0.0);
    surface.trims = {{flat_band()}};
    const TrimRegion region{surface, kTrimEdgeError};
    LONGS_EQUAL(1, region.loops().size());
    CHECK(region.loops().front().size() > 300);
    int inside = 0;
    for (int i = 0; i < kLooks; ++i) {
        // Half of them beside the waves.
        const double u = std::fmod(0.618 * i, 1.0);
        const double v =
            i % 2 == 0 ? std::fmod(0.7548 * i, 1.0) : 0.3 + 4e-3 * (std::fmod(0.57 * i, 1.0) - 0.5);
        const bool expected = is_inside_loops(region, {u, v});
        CHECK_EQUAL(expected, region.inside(u, v));
        inside += expected ? 1 : 0;
        TrimRegion::Remnant left;
        constexpr double kHalf = 1e-5;
        const TrimRegion::Part part =
            region.remnant(u - kHalf, u + kHalf, v - kHalf, v + kHalf, left);
        CHECK(part == region.part(u - kHalf, u + kHalf, v - kHalf, v + kHalf));
        if (part != TrimRegion::Part::kCut) {
            CHECK_EQUAL(expected, part == TrimRegion::Part::kInside);
        }
    }
    CHECK(inside > kLooks / 10 && inside < kLooks * 9 / 10);
}

TEST(TrimRegion, KeepsItsEdgesInSpaceWithinTheirError)
{
    Surface surface = bent_sheet();
    surface.trims = {{circle_about({0.5, 0.5}, 0.4)}};
    const TrimRegion region{surface, kTrimEdgeError};
    const auto edges = region.edges(surface);
    LONGS_EQUAL(1, edges.size());
    const std::vector<Vec3d>& loop = edges.front();
    CHECK(loop.size() > 10);
    CHECK(norm(loop.front() - loop.back()) == 0);
    for (std::size_t k = 0; k + 1 < loop.size(); ++k) {
        for (const double share : {0.0, 0.25, 0.5, 0.75}) {
            const Vec3d p = loop[k] + (loop[k + 1] - loop[k]) * share;
            const double angle = std::atan2(p.y, p.x);
            const Vec2d round{0.4 * kSide * std::cos(angle), 0.4 * kSide * std::sin(angle)};
            const Vec3d edge = point_at(surface, round.x / kSide + 0.5, round.y / kSide + 0.5);
            CHECK(norm(p - edge) <= kTrimEdgeError);
        }
    }
}

}  // namespace
}  // namespace cusp::test
