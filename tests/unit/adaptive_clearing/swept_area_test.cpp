#include "host_tools/cam/adaptive_clearing/swept_area.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

namespace {

constexpr double kPi = 3.14159265358979323846;

SweptArea swept_by_a_line()
{
    SweptArea swept{{-20, -20, 20, 20}, 3.0};
    swept.add(line_edge({-15, 0}, {15, 0}));
    return swept;
}

TEST_GROUP(SweptArea){};

TEST(SweptArea, AStraightCutHasTheAngleOfItsWidth)
{
    const SweptArea swept = swept_by_a_line();
    for (const double width : {0.3, 1.5, 3.0}) {
        const double angle = std::acos(1.0 - width / 3.0);
        // Two discs of the line leave a cusp of 0.001 mm between them.
        DOUBLES_EQUAL(angle, swept.engagement({0, width}, {1, 0}), 2e-3);
        DOUBLES_EQUAL(angle, swept.engagement({0, width}, {-1, 0}), 2e-3);
    }
}

TEST(SweptArea, ASlotHasHalfATurnAndTheLineItselfNone)
{
    const SweptArea swept = swept_by_a_line();
    DOUBLES_EQUAL(kPi, swept.engagement({15.01, 0}, {1, 0}), 0.1);
    DOUBLES_EQUAL(kPi, swept.engagement({0, 12}, {1, 0}), 1e-9);
    DOUBLES_EQUAL(0.0, swept.engagement({3, 0}, {1, 0}, -0.01), 1e-9);
    CHECK(swept.contains({14, 2.9}));
    CHECK(!swept.contains({14, 3.1}));
}

TEST(SweptArea, ASliverThinnerThanTheRasterIsFound)
{
    SweptArea swept = swept_by_a_line();
    swept.add(line_edge({-15, 6.012}, {15, 6.012}));
    const Region2d region{{{line_edge({-9, 1}, {9, 1}), line_edge({9, 1}, {9, 5}),
                            line_edge({9, 5}, {-9, 5}), line_edge({-9, 5}, {-9, 1})}}};
    const std::vector<Vec2d> found = swept.uncut_points(region, 0.003);
    CHECK(!found.empty());
    for (const Vec2d p : found) {
        CHECK(!swept.contains(p));
        DOUBLES_EQUAL(3.006, p.y, 0.004);
    }
    CHECK(swept.uncut_points(region, 0.007).empty());
}

TEST(SweptArea, ATightTurnIsSweptToItsOuterSide)
{
    constexpr double kMissed = 0.0015;  // mm
    for (const double radius : {0.02, 0.1, 0.9, 4.0}) {
        SweptArea swept{{-20, -20, 20, 20}, 3.0};
        swept.add(arc_edge({0, 0}, {radius, radius}, {0, radius}, 1));
        for (int i = 0; i <= 40; ++i) {
            const double angle = kPi * (i / 80.0 - 0.5);
            const Vec2d out{std::cos(angle), std::sin(angle)};
            CHECK(swept.contains(Vec2d{0, radius} + out * (3.0 + radius - kMissed)));
        }
    }
}

TEST(SweptArea, TheAngleIsThatOfPointsOnTheCircle)
{
    constexpr unsigned kSeed = 3;
    constexpr int kPoints = 2000;
    std::mt19937_64 random{kSeed};
    std::uniform_real_distribution<double> place{-9.0, 9.0};
    std::uniform_real_distribution<double> more{0.0, 3.0};
    for (int round = 0; round < 3000; ++round) {
        SweptArea swept{{-20, -20, 20, 20}, 3.0};
        const int count = 1 + round % 12;
        std::vector<std::pair<Vec2d, double>> discs;
        for (int i = 0; i < count; ++i) {
            discs.push_back({{place(random), place(random)}, 3.0 + more(random)});
            swept.add_disc(discs.back().first, discs.back().second);
        }
        // Along an axis the ends of arcs are at the rear; the widest angle is all round.
        const double turn = round % 5 == 0 ? (round / 5 % 8) * 0.25 * kPi : place(random);
        const Vec2d heading{std::cos(turn), std::sin(turn)};
        const double widened = (round % 3) * 0.25 * kPi;
        const double shrink = (round % 7 - 3) * 0.08;
        // Also in the middle of a disc, and where two circles touch.
        const Vec2d centre = round % 11 == 0   ? discs[0].first
                             : round % 11 == 1 ? discs[0].first + Vec2d{3.0 + discs[0].second, 0}
                                               : Vec2d{place(random), place(random)};
        const double most = std::min(0.5 * kPi + widened, kPi);
        int open = 0;
        for (int i = 0; i < kPoints; ++i) {
            const double angle = turn + most * (2.0 * (i + 0.5) / kPoints - 1.0);
            const Vec2d on = centre + Vec2d{std::cos(angle), std::sin(angle)} * 3.0;
            open += std::none_of(discs.begin(), discs.end(), [&](const auto& disc) {
                return norm(on - disc.first) < disc.second - shrink;
            });
        }
        const double sampled = 2.0 * most * open / kPoints;
        // Half a sample at each end of each disc's arc.
        const double off = 2.0 * most / kPoints * (count + 1);
        const double angle = swept.engagement(centre, heading, shrink, widened);
        CHECK_TEXT(std::abs(angle - sampled) <= off, ("round " + std::to_string(round)).c_str());
    }
}

TEST(SweptArea, TheBoundOfAnEdgeIsNowherePassed)
{
    constexpr unsigned kSeed = 7;
    std::mt19937_64 random{kSeed};
    std::uniform_real_distribution<double> place{-8.0, 8.0};
    for (int round = 0; round < 300; ++round) {
        SweptArea swept{{-20, -20, 20, 20}, 3.0};
        for (int i = 0; i < 4; ++i) {
            swept.add(line_edge({place(random), place(random)}, {place(random), place(random)}));
        }
        const Vec2d a{place(random), place(random)};
        const Vec2d b{place(random), place(random)};
        const Edge way = round % 2 == 0
                             ? line_edge(a, b)
                             : arc_edge(a, b, (a + b) * 0.5 + left_normal(b - a) * 0.3, 1);
        const double bound = swept.engagement_bound(way, 0.5 * kPi);
        for (int i = 0; i <= 200; ++i) {
            const double share = i / 200.0;
            CHECK(swept.engagement(point_on(way, share), tangent_on(way, share)) <= bound + 1e-9);
        }
    }
}

}  // namespace

}  // namespace cusp::test
