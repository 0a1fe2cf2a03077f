// Parts of passes above the stock's top are left out, parts below it stay.
#include "host_tools/cam/finishing/passes_in_stock.hpp"

#include <algorithm>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

using namespace cusp;
using namespace cusp::finishing;
using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::ToolMove;

namespace {

constexpr double kTop = 10;
constexpr double kLinked = 4;

SurfacePass through(const Points& points) { return {points, {}, {}}; }

// As through(), of moves.
SurfacePass by_moves(const Points& points)
{
    SurfacePass pass{points, {}, {}};
    for (std::size_t k = 1; k < points.size(); ++k) {
        pass.moves.push_back({MoveKind::kCut, LineTo{points[k]}});
    }
    return pass;
}

std::vector<SurfacePass> kept(const SurfacePass& pass)
{
    return passes_in_stock(
        {pass}, [](Vec3d a, Vec3d b) { return std::min(a.z, b.z) >= kTop - 1e-6; }, kLinked);
}

void check_points(const Points& wanted, const Points& found)
{
    UNSIGNED_LONGS_EQUAL(wanted.size(), found.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        DOUBLES_EQUAL(0, norm(wanted[k] - found[k]), 0);
    }
}

}  // namespace

TEST_GROUP(PassesInStock){};

TEST(PassesInStock, PassesBelowTheTopStayAsTheyAre)
{
    const Points low{{0, 0, 9}, {5, 0, 2}, {50, 0, 9.99}};
    const auto found = kept(through(low));
    UNSIGNED_LONGS_EQUAL(1, found.size());
    check_points(low, found[0].points);
}

TEST(PassesInStock, PassesOnTheTopOrOverItAreLeftOut)
{
    UNSIGNED_LONGS_EQUAL(0, kept(through({{0, 0, 10}, {50, 0, 10}})).size());
    UNSIGNED_LONGS_EQUAL(0, kept(through({{0, 0, 10.004}, {1, 0, 11}})).size());
    UNSIGNED_LONGS_EQUAL(0, kept(by_moves({{0, 0, 10}, {50, 0, 10}})).size());
}

TEST(PassesInStock, LongPartsOnTheTopAreLeftOutAndPassesDivided)
{
    for (const auto& make : {through, by_moves}) {
        const auto found = kept(make({{0, 0, 10},
                                      {20, 0, 10},
                                      {21, 0, 5},
                                      {25, 0, 5},
                                      {26, 0, 10},
                                      {40, 0, 10},
                                      {41, 0, 8},
                                      {42, 0, 10},
                                      {60, 0, 10}}));
        UNSIGNED_LONGS_EQUAL(2, found.size());
        check_points({{20, 0, 10}, {21, 0, 5}, {25, 0, 5}, {26, 0, 10}}, found[0].points);
        check_points({{40, 0, 10}, {41, 0, 8}, {42, 0, 10}}, found[1].points);
        UNSIGNED_LONGS_EQUAL(found[0].moves.empty() ? 0 : 3, found[0].moves.size());
    }
}

TEST(PassesInStock, PartsAsShortAsALinkStay)
{
    const Points way{{0, 0, 5}, {1, 0, 10}, {4, 0, 10}, {5, 0, 5}};
    const auto found = kept(through(way));
    UNSIGNED_LONGS_EQUAL(1, found.size());
    check_points(way, found[0].points);
}

TEST(PassesInStock, AnArcThatDipsBetweenItsEndsCuts)
{
    SurfacePass pass{{{0, 0, 10}, {10, 0, 10}}, {}, {}};
    nurbs::Curve dip;
    dip.degree = 2;
    dip.knots = {0, 0, 0, 1, 1, 1};
    dip.points = {{0, 0, 10}, {5, 0, 4}, {10, 0, 10}};
    dip.weights = {1, 1, 1};
    pass.moves = {{MoveKind::kCut, toolpath::NurbsTo{dip}}};
    UNSIGNED_LONGS_EQUAL(1, kept(pass).size());
}

TEST(PassesInStock, LongLinesAreDividedWhereTheMiddleIsIdle)
{
    const auto is_idle = [](Vec3d a, Vec3d b) {
        return std::min(a.x, b.x) >= 10 && std::max(a.x, b.x) <= 30;
    };
    for (const auto& make : {through, by_moves}) {
        const SurfacePass divided = divided_where_idle(make({{0, 0, 5}, {40, 0, 5}}), is_idle);
        check_points({{0, 0, 5}, {10, 0, 5}, {30, 0, 5}, {40, 0, 5}}, divided.points);
        const auto found = passes_in_stock({divided}, is_idle, kLinked);
        UNSIGNED_LONGS_EQUAL(2, found.size());
        check_points({{0, 0, 5}, {10, 0, 5}}, found[0].points);
        check_points({{30, 0, 5}, {40, 0, 5}}, found[1].points);
        const SurfacePass whole = divided_where_idle(make({{0, 0, 5}, {9, 0, 5}}), is_idle);
        UNSIGNED_LONGS_EQUAL(2, whole.points.size());
    }
}

TEST(PassesInStock, OneCurveStaysUnlessAllOfItIsOverTheStock)
{
    nurbs::Curve curve;
    curve.degree = 1;
    curve.knots = {0, 0, 1, 1};
    curve.points = {{0, 0, 10}, {10, 0, 9}};
    SurfacePass pass{{{0, 0, 10}, {10, 0, 9}}, curve, {}};
    const auto found = kept(pass);
    UNSIGNED_LONGS_EQUAL(1, found.size());
    CHECK(found[0].curve.has_value());
    pass.points.back().z = 10;
    UNSIGNED_LONGS_EQUAL(0, kept(pass).size());
}
