// Loops by their closed forms: lengths, areas, what lies in what, and how far open ends are apart.
#include "host_tools/job/import/loop_nesting.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "tests/support/loops.hpp"

using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::import;
using namespace cusp::test;
using cusp::job::LoopNesting;
using cusp::job::OpenChain;

namespace {

std::vector<Curve> square_curves(double low, double high)
{
    return loop_of({{low, low}, {high, low}, {high, high}, {low, high}});
}

std::vector<Curve> joined(const std::vector<std::vector<Curve>>& parts)
{
    std::vector<Curve> out;
    for (const auto& part : parts) {
        out.insert(out.end(), part.begin(), part.end());
    }
    return out;
}

}  // namespace

TEST_GROUP(LoopNesting){};

TEST(LoopNesting, CirclesHaveTheirLengthAndArea)
{
    const LoopNesting found = nest_loops({import::arc_curve({30, -20}, 12.5, 0.3, -2 * kPi)});
    UNSIGNED_LONGS_EQUAL(1, found.loops.size());
    DOUBLES_EQUAL(2 * kPi * 12.5, found.loops[0].length, 1e-8);
    DOUBLES_EQUAL(kPi * 12.5 * 12.5, found.loops[0].area, 1e-7);
    CHECK(!found.loops[0].counter_clockwise);
}

TEST(LoopNesting, AnIslandInAHoleInAPlateIsThreeDeep)
{
    // in disorder, one side turned, two holes beside each other
    std::vector<Curve> curves = joined({{import::arc_curve({20, 20}, 2, 0, 2 * kPi)},
                                        square_curves(10, 40),
                                        {import::arc_curve({70, 70}, 8, 0, 2 * kPi)},
                                        square_curves(0, 100)});
    std::swap(curves[2], curves[7]);
    curves[3] = reversed(curves[3]);
    const LoopNesting found = nest_loops(curves);
    UNSIGNED_LONGS_EQUAL(4, found.loops.size());
    UNSIGNED_LONGS_EQUAL(0, found.open.size());
    const double areas[] = {10000, 900, 64 * kPi, 4 * kPi};
    const int parents[] = {-1, 0, 0, 1};
    const int depths[] = {0, 1, 1, 2};
    for (std::size_t k = 0; k < 4; ++k) {
        DOUBLES_EQUAL(areas[k], found.loops[k].area, 1e-6);
        LONGS_EQUAL(parents[k], found.loops[k].parent);
        LONGS_EQUAL(depths[k], found.loops[k].depth);
    }
}

TEST(LoopNesting, AnOpenChainNamesItsEndsAndTheGap)
{
    std::vector<Curve> curves = square_curves(0, 10);
    curves.back().points.back() = {0, 0.5, 0};  // stops short of the corner
    std::rotate(curves.begin(), curves.begin() + 2, curves.end());
    const LoopNesting found = nest_loops(curves);
    UNSIGNED_LONGS_EQUAL(0, found.loops.size());
    UNSIGNED_LONGS_EQUAL(1, found.open.size());
    const OpenChain& chain = found.open[0];
    UNSIGNED_LONGS_EQUAL(4, chain.curves);
    DOUBLES_EQUAL(39.5, chain.length, 1e-9);
    DOUBLES_EQUAL(0.5, chain.gap, 1e-9);
    DOUBLES_EQUAL(0.5, std::abs(chain.gap_from.y - chain.gap_to.y), 1e-9);
    DOUBLES_EQUAL(0, chain.gap_from.x, 1e-9);
}

TEST(LoopNesting, GapsUpToTheToleranceAreJoinedAndCounted)
{
    std::vector<Curve> curves = square_curves(0, 10);
    curves.back().points.back() = {0, 0.015, 0};
    const LoopNesting found = nest_loops(curves, 0.02);
    UNSIGNED_LONGS_EQUAL(1, found.loops.size());
    UNSIGNED_LONGS_EQUAL(4, found.loops[0].curves.size());
    UNSIGNED_LONGS_EQUAL(1, found.bridged);
    DOUBLES_EQUAL(0.015, found.widest_gap, 1e-12);
    UNSIGNED_LONGS_EQUAL(1, nest_loops(curves, 0.01).open.size());
}

TEST(LoopNesting, TheGapIsToTheNearestChain)
{
    const LoopNesting found = nest_loops(joined({
        {Curve{1, {0, 0, 1, 1}, {{0, 0, 0}, {10, 0, 0}}, {1, 1}}},
        {Curve{1, {0, 0, 1, 1}, {{10.2, 0, 0}, {20, 5, 0}}, {1, 1}}},
    }));
    UNSIGNED_LONGS_EQUAL(2, found.open.size());
    DOUBLES_EQUAL(0.2, found.open[0].gap, 1e-9);
    DOUBLES_EQUAL(0.2, found.open[1].gap, 1e-9);
}

TEST(LoopNesting, WhatIsDrawnTwiceCountsOnce)
{
    std::vector<Curve> curves = square_curves(0, 10);
    curves.push_back(reversed(curves[1]));
    curves.push_back(curves[3]);
    const LoopNesting found = nest_loops(curves);
    UNSIGNED_LONGS_EQUAL(2, found.repeated);
    UNSIGNED_LONGS_EQUAL(1, found.loops.size());
    UNSIGNED_LONGS_EQUAL(0, found.open.size());
}

TEST(LoopNesting, CrossingsAreNamed)
{
    const LoopNesting bow = nest_loops(loop_of({{0, 0}, {10, 10}, {10, 0}, {0, 11}}));
    UNSIGNED_LONGS_EQUAL(1, bow.loops.size());
    CHECK(bow.loops[0].crossing.has_value());
    CHECK(!bow.crossing);
    const LoopNesting two = nest_loops(joined({square_curves(0, 10), square_curves(5, 15)}));
    CHECK(two.crossing.has_value());
}
