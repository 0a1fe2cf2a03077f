// Closed polylines stay loops; loose curves go on in one way at every junction.
#include "host_tools/job/import/path_chains.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "tests/support/drawn_dxf.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::test;
using cusp::job::LoopNesting;

namespace {

DrawingPath closed_path(const std::vector<Vec2d>& corners)
{
    DrawingPath path{{}, true};
    for (std::size_t k = 0; k < corners.size(); ++k) {
        path.curves.push_back(line_curve(corners[k], corners[(k + 1) % corners.size()]));
    }
    return path;
}

std::vector<DrawingPath> loose(const std::vector<Vec2d>& corners)
{
    std::vector<DrawingPath> paths;
    for (const nurbs::Curve& curve : closed_path(corners).curves) {
        paths.push_back({{curve}, false});
    }
    return paths;
}

std::vector<DrawingPath> together(std::vector<DrawingPath> a, const std::vector<DrawingPath>& b)
{
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::vector<Vec2d> box(double x, double y, double width, double height)
{
    return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

void has_areas(const std::vector<double>& wanted, const LoopNesting& nesting)
{
    UNSIGNED_LONGS_EQUAL(wanted.size(), nesting.loops.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        DOUBLES_EQUAL(wanted[k], nesting.loops[k].area, 1e-6);
    }
}

}  // namespace

TEST_GROUP(PathChains)
{
    TemporaryFolder folder;
    std::vector<std::string> notes;
};

TEST(PathChains, ClosedPolylinesWithACommonEdgeAreTwoLoops)
{
    const LoopNesting whole =
        nest_loops({closed_path(box(0, 0, 40, 30)), closed_path(box(40, 0, 20, 30))});
    has_areas({1200, 600}, whole);
    CHECK(whole.open.empty() && !whole.crossing && whole.repeated == 0);
    // a part of an edge, slanted, and both the same way round
    const Vec2d a{0, 0};
    const Vec2d b{30, 17};
    const auto on = [&](double t) {
        return a + t * (b - a);
    };
    const LoopNesting part =
        nest_loops({closed_path({a, b, {0, 40}}), closed_path({on(0.213), {20, -9}, on(0.787)})});
    UNSIGNED_LONGS_EQUAL(2, part.loops.size());
    CHECK(!part.crossing);
    LONGS_EQUAL(0, part.loops[1].depth);
    // a grid of cells, each edge twice
    std::vector<DrawingPath> cells;
    for (int k = 0; k < 12; ++k) {
        cells.push_back(closed_path(box(10 * (k % 4), 10 * (k / 4), 10, 10)));
    }
    has_areas(std::vector<double>(12, 100), nest_loops(cells));
}

TEST(PathChains, AnArcIsACommonEdgeToo)
{
    // two halves of a disc whose arcs begin at different places, and a ring round them
    const auto half = [](double from, double sweep) {
        DrawingPath path{{arc_curve({0, 0}, 10, from, sweep)}, true};
        const auto points = path.curves[0].points;
        path.curves.push_back(line_curve(in_plan(points.back()), {0, 0}));
        path.curves.push_back(line_curve({0, 0}, in_plan(points.front())));
        return path;
    };
    const LoopNesting found = nest_loops({half(0.3, 2),
                                          half(2.3, 2.9),
                                          half(5.2, 2 * kPi - 4.9),
                                          {{arc_curve({0, 0}, 10, 1, 2 * kPi)}, true}});
    UNSIGNED_LONGS_EQUAL(4, found.loops.size());
    CHECK(!found.crossing);
    DOUBLES_EQUAL(100 * kPi, found.loops[1].area + found.loops[2].area + found.loops[3].area, 1e-6);
}

TEST(PathChains, WhatIsDrawnOverALoopCountsOnce)
{
    const DrawingPath plate = closed_path(box(0, 0, 40, 30));
    DrawingPath again = plate;
    std::rotate(again.curves.begin(), again.curves.begin() + 1, again.curves.end());
    const LoopNesting twice = nest_loops({plate, again});
    has_areas({1200}, twice);
    UNSIGNED_LONGS_EQUAL(4, twice.repeated);
    const LoopNesting edge = nest_loops({plate, {{plate.curves[2]}, false}});
    has_areas({1200}, edge);
    UNSIGNED_LONGS_EQUAL(1, edge.repeated);
    // but the neighbour of loose lines keeps the edge that they have in common
    has_areas({1200, 600}, nest_loops(together(loose(box(40, 0, 20, 30)), {plate})));
}

TEST(PathChains, LooseLoopsThatTouchAtACornerAreTwo)
{
    std::vector<DrawingPath> pieces = together(loose(box(0, 0, 10, 10)), loose(box(10, 10, 5, 5)));
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::shuffle(pieces.begin(), pieces.end(), std::mt19937{seed});
        const LoopNesting found = nest_loops(pieces);
        has_areas({100, 25}, found);
        CHECK(found.open.empty());
    }
}

TEST(PathChains, ASpurIsTheOpenChainNotItsLoop)
{
    for (const Vec2d from : {Vec2d{10, 0}, Vec2d{0, 10}}) {
        std::vector<DrawingPath> pieces = loose(box(0, 0, 10, 10));
        pieces.insert(pieces.begin() + 1, {{line_curve({25, 3}, from)}, false});
        const LoopNesting found = nest_loops(pieces);
        has_areas({100}, found);
        UNSIGNED_LONGS_EQUAL(1, found.open.size());
        UNSIGNED_LONGS_EQUAL(1, found.open[0].curves);
        UNSIGNED_LONGS_EQUAL(3, found.junction_ends);
        DOUBLES_EQUAL(0, norm(*found.junction - from), 1e-9);
    }
}

TEST(PathChains, ADividedRectangleOfLooseLinesNamesTheJunction)
{
    const std::string file =
        folder.with("d.dxf", dxf_drawing(dxf_line({0, 0}, {10, 0}) + dxf_line({10, 0}, {20, 0}) +
                                         dxf_line({20, 0}, {20, 8}) + dxf_line({20, 8}, {10, 8}) +
                                         dxf_line({10, 8}, {0, 8}) + dxf_line({0, 8}, {0, 0}) +
                                         dxf_line({10, 0}, {10, 8})));
    const std::string said = refusal([&] { read_loops(file, 1, {0.02, {}}, notes); });
    STRCMP_CONTAINS("3 ends meet at x 10 y 0 mm, where more than one way continues", said.c_str());
}

TEST(PathChains, TheOrderOfLooseCurvesChangesNoLoop)
{
    // a figure of two triangles that cross at a vertex, and a closed chain of arcs and lines
    std::vector<DrawingPath> pieces =
        together(loose({{0, 0}, {10, 0}, {5, 5}}), loose({{5, 5}, {10, 10}, {0, 10}}));
    pieces.push_back({{arc_curve({40, 0}, 10, 0, kPi)}, false});
    pieces.push_back({{line_curve({30, 0}, {50, 0})}, false});
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::shuffle(pieces.begin(), pieces.end(), std::mt19937{seed});
        has_areas({50 * kPi, 25, 25}, nest_loops(pieces));
    }
}

TEST(PathChains, EndsThatAreRoundedToThePrecisionOfTheDrawingMeet)
{
    // inches with three decimals: ends one unit apart are 0.025 mm apart
    const std::string soup = dxf_line({0, 0}, {1.125, 0.001}) +
                             dxf_line({1.125, 0}, {1.125, 0.75}) +
                             dxf_line({1.124, 0.75}, {0, 0.75}) + dxf_line({0, 0.749}, {0, 0});
    const std::string file = folder.with("d.dxf", dxf_drawing(soup, {{9, "$INSUNITS"}, {70, "1"}}));
    UNSIGNED_LONGS_EQUAL(1, read_loops(file, 25.4, {0.02, {}}, notes).size());
    STRCMP_CONTAINS("3 gaps of up to 0.0254 mm are joined; the limit is 0.0508 mm (join_gaps)",
                    notes.back().c_str());
    // the key takes the place of both
    const std::string said = refusal([&] { read_loops(file, 25.4, {0.02, 0.01}, notes); });
    STRCMP_CONTAINS("is 0.0254 mm, the limit is 0.01 mm: join_gaps of the operation", said.c_str());
    DOUBLES_EQUAL(0.02, join_limit(0), 1e-12);
    DOUBLES_EQUAL(0.02, join_limit(1e-6), 1e-12);
    DOUBLES_EQUAL(0.1, join_limit(1), 1e-12);
}

TEST(PathChains, ARoundedDrawingOfManyLoopsHasThemAll)
{
    // seeds 0 to 19: loose arcs and lines of slots, rounded to three decimals of an inch
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random{seed};
        std::uniform_real_distribution<double> any{0, 1};
        const auto r3 = [](double x) {
            return std::round(x * 1e3) / 1e3;
        };
        std::vector<std::string> entities;
        for (int k = 0; k < 10; ++k) {
            const Vec2d at{3.0 * k + any(random), any(random)};
            const double r = 0.1 + 0.3 * any(random);
            const double turn = any(random);
            const Vec2d along{std::cos(turn), std::sin(turn)};
            const Vec2d across{-along.y, along.x};
            const auto put = [&](Vec2d p) {
                return Vec2d{r3(p.x), r3(p.y)};
            };
            entities.push_back(dxf_line(put(at - r * across), put(at + along - r * across)));
            entities.push_back(dxf_line(put(at + r * across), put(at + along + r * across)));
            for (const bool last : {false, true}) {
                const Vec2d centre = put(last ? at + along : at);
                const double start = turn * 180 / kPi + (last ? -90 : 90);
                entities.push_back(
                    fmt::format("0\nARC\n8\no\n10\n{}\n20\n{}\n40\n{}\n50\n{}\n51\n{}\n", centre.x,
                                centre.y, r3(r), r3(start), r3(start + 180)));
            }
        }
        std::shuffle(entities.begin(), entities.end(), random);
        std::string all;
        for (const std::string& entity : entities) {
            all += entity;
        }
        const std::string file =
            folder.with("d.dxf", dxf_drawing(all, {{9, "$INSUNITS"}, {70, "1"}}));
        const std::string said = refusal([&] {
            UNSIGNED_LONGS_EQUAL(10, read_loops(file, 25.4, {0.02, {}}, notes).size());
        });
        STRCMP_EQUAL_TEXT("", said.c_str(), ("seed " + std::to_string(seed)).c_str());
    }
}
