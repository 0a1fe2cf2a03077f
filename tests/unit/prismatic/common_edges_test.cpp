// Parts that touch: area stays, and what is left of the outlines is the outline of all.
#include "host_tools/cam/prismatic/common_edges.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"

using namespace cusp;
using namespace cusp::prismatic;
using cusp::offset::arc_edge;
using cusp::offset::Contour;
using cusp::offset::line_edge;
using cusp::offset::Region2d;

namespace {

Contour polygon_of(const std::vector<Vec2d>& corners)
{
    Contour contour;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        contour.push_back(line_edge(corners[k], corners[(k + 1) % corners.size()]));
    }
    return contour;
}

Contour cell_of(double x, double y, double width, double height)
{
    return polygon_of({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}});
}

double outline_length(const Region2d& region)
{
    double sum = 0;
    for (const Contour& contour : region.contours) {
        sum += offset::length(contour);
        for (std::size_t k = 0; k < contour.size(); ++k) {
            const Vec2d next = contour[(k + 1) % contour.size()].start;
            DOUBLES_EQUAL(0, offset::distance(contour[k].end, next), 1e-9);
        }
    }
    return sum;
}

}  // namespace

TEST_GROUP(CommonEdges){};

TEST(CommonEdges, TwoCellsAreOneOutline)
{
    const ContourGroup whole =
        without_common_edges({{cell_of(0, 0, 20, 20), cell_of(20, 5, 20, 10)}});
    UNSIGNED_LONGS_EQUAL(1, whole.region.contours.size());
    DOUBLES_EQUAL(600, offset::area(whole.region), 1e-9);
    DOUBLES_EQUAL(10, whole.common, 1e-9);
    DOUBLES_EQUAL(80 + 60 - 20, outline_length(whole.region), 1e-9);
    DOUBLES_EQUAL(20, whole.place.x, 1e-9);
}

TEST(CommonEdges, PartsThatAreApartOrTouchAtACornerStayAsTheyAre)
{
    for (const Region2d& region : {Region2d{{cell_of(0, 0, 20, 20), cell_of(20.01, 0, 20, 20)}},
                                   Region2d{{cell_of(0, 0, 20, 20), cell_of(20, 20, 5, 5)}}}) {
        const ContourGroup found = without_common_edges(region);
        UNSIGNED_LONGS_EQUAL(2, found.region.contours.size());
        DOUBLES_EQUAL(0, found.common, 1e-12);
        for (std::size_t n = 0; n < 2; ++n) {
            UNSIGNED_LONGS_EQUAL(n, found.sources[n]);
            CHECK(found.region.contours[n].size() == region.contours[n].size());
        }
    }
}

TEST(CommonEdges, ArcsThatFitIntoEachOtherAreCommon)
{
    // the halves of a disc, and a block with a round notch that holds a half
    const auto arc = [](double from, double to, int turn) {
        const auto at = [](double angle) {
            return Vec2d{10 * std::cos(angle), 10 * std::sin(angle)};
        };
        return arc_edge(at(from), at(to), {0, 0}, turn);
    };
    const Contour half{arc(0, kPi / 2, 1), arc(kPi / 2, kPi, 1), line_edge({-10, 0}, {10, 0})};
    Contour block{arc(kPi, 0.4 * kPi, -1), arc(0.4 * kPi, 0, -1)};
    const std::vector<Vec2d> rest{{10, 0}, {20, 0}, {20, 20}, {-20, 20}, {-20, 0}, {-10, 0}};
    for (std::size_t k = 0; k + 1 < rest.size(); ++k) {
        block.push_back(line_edge(rest[k], rest[k + 1]));
    }
    const ContourGroup found = without_common_edges({{half, block}});
    UNSIGNED_LONGS_EQUAL(1, found.region.contours.size());
    DOUBLES_EQUAL(10 * kPi, found.common, 1e-6);
    DOUBLES_EQUAL(800, offset::area(found.region), 1e-6);
}

TEST(CommonEdges, RandomFieldsOfTurnedCellsKeepTheirAreaAndTheOutlineOfAll)
{
    for (unsigned seed = 0; seed < 100; ++seed) {
        std::mt19937 random{seed};
        constexpr int kColumns = 6;
        constexpr int kRows = 5;
        const double turn = 0.01 * static_cast<double>(random() % 600);
        bool filled[kColumns + 2][kRows + 2]{};
        Region2d region;
        const auto placed = [&](double x, double y) {
            return Vec2d{7 * (x * std::cos(turn) - y * std::sin(turn)),
                         7 * (x * std::sin(turn) + y * std::cos(turn))};
        };
        int cells = 0;
        for (int i = 1; i <= kColumns; ++i) {
            for (int j = 1; j <= kRows; ++j) {
                if (random() % 3 != 0) {
                    filled[i][j] = true;
                    ++cells;
                    region.contours.push_back(polygon_of(
                        {placed(i, j), placed(i + 1, j), placed(i + 1, j + 1), placed(i, j + 1)}));
                }
            }
        }
        int sides = 0;
        for (int i = 1; i <= kColumns; ++i) {
            for (int j = 1; j <= kRows; ++j) {
                sides += filled[i][j] ? !filled[i - 1][j] + !filled[i + 1][j] + !filled[i][j - 1] +
                                            !filled[i][j + 1]
                                      : 0;
            }
        }
        std::shuffle(region.contours.begin(), region.contours.end(), random);
        const ContourGroup found = without_common_edges(region);
        const std::string about = "seed " + std::to_string(seed);
        CHECK_TEXT(std::abs(offset::area(found.region) - 49.0 * cells) < 1e-6, about.c_str());
        CHECK_TEXT(std::abs(outline_length(found.region) - 7.0 * sides) < 1e-6, about.c_str());
        CHECK_TEXT(found.sources.size() == found.region.contours.size(), about.c_str());
    }
}
