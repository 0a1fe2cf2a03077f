// Judged by the distance of each edge from each other one.
#include "host_tools/geometry/nesting/nesting.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/generators/draw.hpp"
#include "tests/support/property_cases.hpp"

#include "fmt/format.h"

namespace cusp::test {

using namespace nesting;

namespace {

Polyline rectangle(double width, double height)
{
    return {{0, 0}, {width, 0}, {width, height}, {0, height}, {0, 0}};
}

Polyline placed(const Polyline& polyline, const Place& place)
{
    Polyline moved;
    for (const Vec2d p : polyline) {
        moved.push_back(quarter_turned(p, place.degrees) + place.move);
    }
    return moved;
}

double distance(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d along = b - a;
    const double square = dot(along, along);
    const double share = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return norm(p - a - along * share);
}

bool is_inside(Vec2d p, const Polyline& polyline)
{
    bool inside = false;
    for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
        const Vec2d a = polyline[i];
        const Vec2d b = polyline[i + 1];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
            inside = !inside;
        }
    }
    return inside;
}

// mm; 0 where one lies in the other. Crossing edges have a corner near them in random polygons, or their inside shows it.
double distance(const Polyline& a, const Polyline& b)
{
    if (is_inside(a.front(), b) || is_inside(b.front(), a)) {
        return 0;
    }
    double least = 1e9;
    for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
        for (const Vec2d p : *from) {
            least = is_inside(p, *to) ? 0.0 : least;
            for (std::size_t i = 0; i + 1 < to->size(); ++i) {
                least = std::min(least, distance(p, (*to)[i], (*to)[i + 1]));
            }
        }
    }
    return least;
}

// Star-shaped: convex or not.
Polyline random_polygon(Draw& draw)
{
    const int corners = draw.whole(3, 9);
    const double size = draw.uniform(5, 60);
    Polyline polygon;
    for (int i = 0; i < corners; ++i) {
        const double turn = (i + draw.uniform(0, 0.8)) / corners * 8;  // around the square
        const double reach = size * draw.uniform(0.25, 1);
        const int side = static_cast<int>(turn) / 2;
        const double along = turn - 2 * side - 1;
        polygon.push_back(quarter_turned({reach, reach * along}, 90.0 * side) + Vec2d{7, -3});
    }
    polygon.push_back(polygon.front());
    return polygon;
}

std::string fault_of(const std::vector<Polyline>& placed, const Sheet& sheet)
{
    for (std::size_t i = 0; i < placed.size(); ++i) {
        for (const Vec2d p : placed[i]) {
            const double inside = std::min({p.x, p.y, sheet.size.x - p.x, sheet.size.y - p.y});
            if (inside < sheet.gap - 1e-6) {
                return fmt::format("x {} y {} is {} from the edge", p.x, p.y, inside);
            }
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (const double apart = distance(placed[i], placed[j]); apart < sheet.gap - 1e-6) {
                return fmt::format("pieces {} and {} are {} apart, gap {}", j, i, apart, sheet.gap);
            }
        }
    }
    return "";
}

std::string wrong_nest(unsigned seed)
{
    Draw draw{std::mt19937{seed}};
    const Sheet sheet{{draw.uniform(80, 400), draw.uniform(80, 400)}, draw.uniform(0.5, 10)};
    std::vector<Piece> pieces;
    for (int i = draw.whole(1, 3); i > 0; --i) {
        pieces.push_back({{random_polygon(draw)}, draw.whole(1, 12)});
    }
    const auto places = nest(pieces, sheet);
    std::vector<Polyline> all;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (places[k].size() > static_cast<std::size_t>(pieces[k].count)) {
            return fmt::format("seed {}: too many", seed);
        }
        for (const Place& place : places[k]) {
            all.push_back(placed(pieces[k].polylines.front(), place));
        }
    }
    const std::string fault = fault_of(all, sheet);
    return fault.empty() ? "" : fmt::format("seed {}: {}", seed, fault);
}

}  // namespace

TEST_GROUP(Nesting){};

TEST(Nesting, KeepsTheGapBetweenRandomPieces)
{
    STRCMP_EQUAL("", broken_cases(property_seed(1), property_cases(60), wrong_nest).c_str());
}

TEST(Nesting, PlacesRectanglesThatFillTheSheetExactly)
{
    const auto places = nest({{{rectangle(100, 50)}, 100}}, {{600, 400}, 0});
    LONGS_EQUAL(48, places.front().size());
    DOUBLES_EQUAL(0, places.front().front().move.x, 0);
}

TEST(Nesting, TurnsWhatFitsTheOtherWayAlone)
{
    const auto places = nest({{{rectangle(20, 90)}, 3}}, {{100, 100}, 2});
    LONGS_EQUAL(3, places.front().size());
    LONGS_EQUAL(4, nest({{{rectangle(90, 20)}, 9}}, {{110, 100}, 3}).front().size());
}

TEST(Nesting, LaysAnglesIntoEachOther)
{
    const Polyline angle{{0, 0}, {60, 0}, {60, 15}, {15, 15}, {15, 60}, {0, 60}, {0, 0}};
    const auto places = nest({{{angle}, 10}}, {{140, 100}, 2});
    // boxes alone: two in a row, one row
    CHECK(places.front().size() >= 4);
}

TEST(Nesting, LeavesOutWhatDoesNotFit)
{
    const auto places =
        nest({{{rectangle(300, 10)}, 1}, {{rectangle(20, 10)}, 2}}, {{100, 100}, 1});
    LONGS_EQUAL(0, places[0].size());
    LONGS_EQUAL(2, places[1].size());
    LONGS_EQUAL(0, nest({{{rectangle(1e5, 1e5)}, 1}}, {{1, 1}, 0}).front().size());
    LONGS_EQUAL(0, nest({{{rectangle(1, 1)}, 1}}, {{10, 10}, 1e5}).front().size());
}

}  // namespace cusp::test
