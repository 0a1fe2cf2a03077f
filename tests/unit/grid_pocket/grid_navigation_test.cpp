// The order of cells: the paper's priorities, and the cost of leaving dead ends.
#include "host_tools/cam/grid_pocket/grid_navigation.hpp"

#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::grid_pocket;
using namespace cusp::offset;

namespace {

Contour polygon(const std::vector<Vec2d>& corners)
{
    Contour out;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        out.push_back(line_edge(corners[i], corners[(i + 1) % corners.size()]));
    }
    return out;
}

// The pockets of Choi, Cho & Kim, in inches.
const std::vector<Vec2d> kRectangle{{0, 0}, {3, 0}, {3, 2}, {0, 2}};
const std::vector<Vec2d> kPolygon{{0, 0},    {2.5, 0}, {3.5, .75}, {3, 1.5},   {3.5, 2.5},
                                  {2, 2.25}, {1.5, 3}, {.25, 2.5}, {.75, 1.25}};

NavigationRules open_rules(const CellGrid& grid)
{
    NavigationRules rules;
    rules.free = [&](Cell c) {
        return grid.inside(c);
    };
    rules.clear_step = [](Cell, Cell) {
        return true;
    };
    rules.clear_link = [](Vec2d, Vec2d) {
        return true;
    };
    return rules;
}

void check_visits_each_once(const CellGrid& grid, const Navigation& navigation)
{
    std::set<std::size_t> seen;
    std::size_t bends = 0;
    for (const NavigationStep& step : navigation.steps) {
        CHECK(grid.inside(step.cell));
        CHECK(seen.insert(grid.index(step.cell)).second);
        bends += step.bends.size();
    }
    LONGS_EQUAL(static_cast<int>(grid.count_inside()), static_cast<int>(seen.size()));
    LONGS_EQUAL(navigation.backtracks, static_cast<int>(bends));
    CHECK(navigation.backtracks * 100 <= static_cast<int>(navigation.steps.size()));
}

}  // namespace

TEST_GROUP(GridNavigation){};

TEST(GridNavigation, TurnsRightThenGoesOnThenLeft)
{
    // Three by three cells: along the lower side, up, back and into the middle, always to the right
    // where that is free and along the wall where it is not.
    const RegionOffset pocket{{{polygon({{0, 0}, {5, 0}, {5, 5}, {0, 5}})}}};
    const CellGrid grid{pocket, 1, 1, 1};
    const Navigation navigation = navigate(grid, open_rules(grid));
    const std::vector<std::pair<int, int>> expected{{1, 1}, {2, 1}, {3, 1}, {3, 2}, {3, 3},
                                                    {2, 3}, {1, 3}, {1, 2}, {2, 2}};
    LONGS_EQUAL(expected.size(), navigation.steps.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        LONGS_EQUAL(expected[i].first, navigation.steps[i].cell.column);
        LONGS_EQUAL(expected[i].second, navigation.steps[i].cell.row);
    }
}

TEST(GridNavigation, OfThePapersRectangleHas2016CellsAndNoDeadEnd)
{
    const RegionOffset pocket{{{polygon(kRectangle)}}};
    const CellGrid grid{pocket, .05, .05, .125};
    const Navigation navigation = navigate(grid, open_rules(grid));
    LONGS_EQUAL(2016, grid.count_inside());
    LONGS_EQUAL(2016, navigation.steps.size());
    LONGS_EQUAL(0, navigation.dead_ends);
}

TEST(GridNavigation, OfThePapersPolygonHas712CellsAndAtMostOnePercentOfStepsBack)
{
    const RegionOffset pocket{{{polygon(kPolygon)}}};
    const CellGrid grid{pocket, .125, .0625, .125};
    const Navigation navigation = navigate(grid, open_rules(grid));
    LONGS_EQUAL(712, grid.count_inside());
    check_visits_each_once(grid, navigation);
    CHECK(navigation.backtracks * 100 <= static_cast<int>(navigation.steps.size()));
}

TEST(GridNavigation, EndsAtTheWallWhenReversed)
{
    const RegionOffset pocket{{{polygon(kRectangle)}}};
    const CellGrid grid{pocket, .05, .05, .125};
    const Navigation navigation = reversed(navigate(grid, open_rules(grid)));
    CHECK(navigation.steps.front().kind == StepKind::kEnter);
    LONGS_EQUAL(2, navigation.steps.back().cell.column);
    LONGS_EQUAL(2, navigation.steps.back().cell.row);
}

TEST(GridNavigation, VisitsEveryCellOfRandomPocketsOnce)
{
    constexpr unsigned kSeed = 1112;
    std::printf("GridNavigation seed %u\n", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> reach{6, 30};
    for (int round = 0; round < 150; ++round) {
        std::vector<Vec2d> star;
        const int corners = 5 + round % 12;
        for (int i = 0; i < corners; ++i) {
            const double angle = 6.283185307179586 * i / corners;
            star.push_back(Vec2d{std::cos(angle), std::sin(angle)} * reach(random));
        }
        const RegionOffset pocket{{{polygon(star)}}};
        const CellGrid grid{pocket, 0.8, 1.1, 1.5};
        NavigationRules rules = open_rules(grid);
        // Links only as far as two cells, so that longer ones bend.
        rules.clear_link = [](Vec2d a, Vec2d b) {
            return norm(a - b) <= 2.2;
        };
        check_visits_each_once(grid, navigate(grid, rules));
    }
}

TEST(GridNavigation, EntersEachPartOfAPocketThatNarrowsTooMuch)
{
    const RegionOffset pocket{{{polygon({{0, 0},
                                         {10, 0},
                                         {10, 4},
                                         {14, 4},
                                         {14, 0},
                                         {24, 0},
                                         {24, 10},
                                         {14, 10},
                                         {14, 5},
                                         {10, 5},
                                         {10, 10},
                                         {0, 10}})}}};
    const CellGrid grid{pocket, 1, 1, 2};
    const Navigation navigation = navigate(grid, open_rules(grid));
    int enters = 0;
    for (const NavigationStep& step : navigation.steps) {
        enters += step.kind == StepKind::kEnter ? 1 : 0;
    }
    LONGS_EQUAL(2, enters);
}
