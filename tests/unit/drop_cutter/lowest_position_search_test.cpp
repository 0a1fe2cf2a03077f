// The lowest position of a tool over points that it cannot touch, compared with the best of
// positions tried one by one, and with closed forms.
#include "host_tools/geometry/drop_cutter/lowest_position_search.hpp"

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::drop_cutter;
using namespace cusp::nurbs;
using namespace cusp::toolpath;

namespace {

Surface facet(Vec3d a, Vec3d b, Vec3d c, Vec3d d)
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.points = {a, b, c, d};
    s.weights = {1, 1, 1, 1};
    return s;
}

LowestPositionSearch search_over(const DropCutter& floor, const Tool& tool, double keep_off)
{
    return {tool, keep_off, 0.125 * tool.radius, 3e-4, [&floor](double x, double y) {
                return drop_tool(floor, x, y);
            }};
}

// The least height that any position on a grid leaves at the point. Positions that only graze the
// point do not count: their heights depend on the floor's accuracy.
double least_tried(const DropCutter& floor, const Tool& tool, Vec3d place, double pitch)
{
    constexpr double kCovered = 0.9999;
    double least = 1e300;
    const auto first = [&](double at) {
        return std::ceil((at - tool.radius) / pitch) * pitch;
    };
    for (double x = first(place.x); x <= place.x + tool.radius; x += pitch) {
        for (double y = first(place.y); y <= place.y + tool.radius; y += pitch) {
            const double away = std::hypot(x - place.x, y - place.y);
            const double tip = floor.tip_height({x, y});
            if (away <= kCovered * tool.radius && tip > -kUnbounded) {
                least = std::min(least, tip + profile_height(tool, away));
            }
        }
    }
    return least;
}

}  // namespace

TEST_GROUP(LowestPositionSearch){};

// In a valley between planes of slope 1 and 2 the ball's centre is where both distances are R.
TEST(LowestPositionSearch, FindsTheBallOnBothSidesOfAFurrow)
{
    const std::vector<Surface> furrow{facet({-10, -10, 10}, {-10, 10, 10}, {0, -10, 0}, {0, 10, 0}),
                                      facet({0, -10, 0}, {0, 10, 0}, {10, -10, 20}, {10, 10, 20})};
    const Tool ball{1, ToolShape::kBall, 2.0, 2.0};
    const DropCutter floor{furrow, ball, 1e-5};
    LowestPositionSearch search = search_over(floor, ball, 0);
    // z + x = R sqrt 2, z - 2 x = R sqrt 5
    const double x = (std::sqrt(2.0) - std::sqrt(5.0)) * 2.0 / 3.0;
    const double z = 2.0 * std::sqrt(2.0) - x;
    const auto answer = search.lowest_over({0, 0.3, 0}, 1e9);
    CHECK(answer.has_value());
    DOUBLES_EQUAL(z - std::sqrt(4.0 - x * x), answer->height, 1e-3);
}

TEST(LowestPositionSearch, ATouchedPlaceTakesOneDropAtTheGuess)
{
    const std::vector<Surface> plane{facet({-10, -10, 0}, {-10, 10, 0}, {10, -10, 5}, {10, 10, 5})};
    const Tool ball{1, ToolShape::kBall, 2.0, 2.0};
    const DropCutter floor{plane, ball, 1e-5};
    int drops = 0;
    LowestPositionSearch search{ball, 0, 0.25, 3e-4, [&](double x, double y) {
                                    ++drops;
                                    return drop_tool(floor, x, y);
                                }};
    const double level = 0.25 / std::sqrt(1 + 0.0625);
    const auto answer = search.lowest_over({0, 0, 2.5}, 1e9, 2.5 + 1e-4, Vec2d{-2.0 * level, 0});
    CHECK(answer.has_value());
    DOUBLES_EQUAL(2.5, answer->height, 1e-4);
    LONGS_EQUAL(1, drops);
}

// Two twisted sheets with a gap between them that is too narrow for the tools, cliffs on both
// sides.
TEST(LowestPositionSearch, IsNoHigherThanTheBestOfManyPositions)
{
    constexpr unsigned kSeed = 71;
    std::mt19937 random{kSeed};
    const auto any = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random);
    };
    const std::vector<Tool> tools{{1, ToolShape::kBall, 1.5, 1.5},
                                  {2, ToolShape::kBull, 1.5, 0.5},
                                  {3, ToolShape::kFlat, 1.5, 0.0}};
    for (int round = 0; round < 6; ++round) {
        // Drawn one by one: arguments of a call have no order.
        std::array<double, 9> z{};
        for (double& each : z) {
            each = any(-1, 1);
        }
        const double gap = 1.9 + 0.9 * z[8];
        const std::vector<Surface> sheets{
            facet({-4, -3, z[0]}, {-4, 3, z[1]}, {-gap / 2, -3, z[2]}, {-gap / 2, 3, z[3]}),
            facet({gap / 2, -3, z[4]}, {gap / 2, 3, z[5]}, {4, -3, z[6]}, {4, 3, z[7]})};
        for (const Tool& tool : tools) {
            const DropCutter floor{sheets, tool, 1e-4};
            LowestPositionSearch search = search_over(floor, tool, 0);
            for (int k = 0; k < 3; ++k) {
                const double x = any(-3, 3);
                const Vec3d place{x, any(-2, 2), 0};
                const auto answer = search.lowest_over(place, 1e9);
                // Other tools are known only by the search's own grid.
                const bool ball = tool.shape == ToolShape::kBall;
                const double tried = least_tried(floor, tool, place, ball ? 0.02 : search.pitch());
                const std::string where =
                    "seed " + std::to_string(kSeed) + " round " + std::to_string(round) + " tool " +
                    std::to_string(tool.number) + ": " +
                    std::to_string(answer ? answer->height : 0) + " > " + std::to_string(tried);
                CHECK_TEXT(answer && answer->height <= tried + 1e-3, where.c_str());
                // and the tool really reaches it
                const double tip = answer->centre.z - tool.corner_radius;
                CHECK(tip >= floor.tip_height({answer->centre.x, answer->centre.y}) - 1e-3);
            }
        }
    }
}

// A steep sheet between level ones: on it and beside its rims usually only the ball's side reaches
// a point.
TEST(LowestPositionSearch, FindsWhereOnlyTheFlankOfTheBallGetsLower)
{
    constexpr unsigned kSeed = 12;
    constexpr double kMore = 0.03;
    std::mt19937 random{kSeed};
    const auto any = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random);
    };
    const Tool ball{1, ToolShape::kBall, 3.0, 3.0};
    for (int round = 0; round < 100; ++round) {
        const double wide = any(0.5, 1.5);
        const double rise = any(1, 4);
        const double left = any(0, 1) < 0.5 ? 0 : rise;
        const double right = rise - left;
        const double low = any(-1, 1);
        const double high = rise + any(-1, 1);
        const std::vector<Surface> sheets{
            facet({-6, 0, low + any(-0.5, 0.5)}, {-6, 8, low + any(-0.5, 0.5)}, {0, 0, low},
                  {0, 8, low + any(-0.5, 0.5)}),
            facet({0.1, 0, left}, {0.1, 8, left}, {wide, 0, right}, {wide, 8, right}),
            facet({wide + 0.1, 0, high}, {wide + 0.1, 8, high + any(-0.5, 0.5)},
                  {wide + 6, 0, high + any(-0.5, 0.5)}, {wide + 6, 8, high})};
        const DropCutter floor{sheets, ball, 1e-4};
        LowestPositionSearch search = search_over(floor, ball, 0.006);
        const double share = any(0, 1);
        const Vec3d place{0.1 + share * (wide - 0.1), any(0, 1) < 0.5 ? 0 : any(0, 0.1),
                          left + share * (right - left)};
        const double resolution = least_tried(floor, ball, place, 0.1) + kMore;
        const auto answer = search.lowest_over(place, resolution);
        const std::string where =
            "seed " + std::to_string(kSeed) + " round " + std::to_string(round) + ": " +
            std::to_string(answer ? answer->height : 0) + " > " + std::to_string(resolution);
        CHECK_TEXT(answer && answer->height <= resolution, where.c_str());
    }
}
