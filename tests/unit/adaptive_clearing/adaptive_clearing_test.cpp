#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

Region2d rectangle(double x, double y)
{
    return {{{line_edge({0, 0}, {x, 0}), line_edge({x, 0}, {x, y}), line_edge({x, y}, {0, y}),
              line_edge({0, y}, {0, 0})}}};
}

AdaptiveSettings settings(double degrees)
{
    AdaptiveSettings result;
    result.tool_radius = 3.0;
    result.wall_clearance = 3.01;
    result.max_engagement = degrees * kDegree;
    result.tolerance = 0.005;
    result.corner = 0.02;
    return result;
}

double least_x(const AdaptivePath& path)
{
    double least = 1e300;
    for (const AdaptiveRun& run : path.runs) {
        for (const Edge& edge : run.path) {
            least = std::min({least, edge.start.x, edge.end.x});
        }
    }
    return least;
}

double distance_to(const AdaptivePath& path, Vec2d place)
{
    double least = 1e300;
    for (const AdaptiveRun& run : path.runs) {
        for (const Edge& edge : run.path) {
            least = std::min(least, offset::distance_to(edge, place));
        }
    }
    return least;
}

TEST_GROUP(AdaptiveClearing){};

// No way is shorter than the area over the width of a straight cut; the tool goes around along the
// wall, and about as far to and from there.
TEST(AdaptiveClearing, ClearsARoundPocketInHardlyMoreThanTheShortestWay)
{
    constexpr double kRadius = 40.0;
    constexpr int kSides = 180;
    Contour contour;
    const auto corner = [&](int i) {
        return Vec2d{std::cos(2.0 * i * kDegree), std::sin(2.0 * i * kDegree)} * kRadius;
    };
    for (int i = 0; i < kSides; ++i) {
        contour.push_back(line_edge(corner(i), corner((i + 1) % kSides)));
    }
    const Region2d region{{contour}};
    for (const double degrees : {45.0, 60.0, 90.0}) {
        const AdaptivePath path = clear_adaptively(region, settings(degrees));
        const double width = 3.0 * (1.0 - std::cos(degrees * kDegree));
        CHECK(path.length > area(region) / width);
        CHECK(path.length < area(region) / width + 2.0 * 360.0 * kDegree * (kRadius - 3.01));
        CHECK(path.engagement_bound <= degrees * kDegree);
        CHECK(path.over.empty());
        CHECK(path.left.empty());
    }
}

TEST(AdaptiveClearing, BeginsWithAHelixAndReachesTheWalls)
{
    const AdaptivePath path = clear_adaptively(rectangle(30, 24), settings(60.0));
    CHECK(path.runs.front().helix.has_value());
    CHECK(path.engagement_bound <= 60.0 * kDegree);
    CHECK(path.engagement_bound > 40.0 * kDegree);
    DOUBLES_EQUAL(3.01, least_x(path), 1e-6);
}

TEST(AdaptiveClearing, RunsAreTangentChains)
{
    for (const AdaptiveRun& run : clear_adaptively(rectangle(30, 24), settings(60.0)).runs) {
        for (std::size_t i = 1; i < run.path.size(); ++i) {
            DOUBLES_EQUAL(0.0, distance(run.path[i - 1].end, run.path[i].start), 1e-6);
            CHECK(dot(tangent_at_end(run.path[i - 1]), tangent_at_start(run.path[i])) > 0.99);
        }
    }
}

TEST(AdaptiveClearing, ASlotAsWideAsTheToolIsCutAndListed)
{
    const AdaptivePath path = clear_adaptively(rectangle(30, 6.1), settings(60.0));
    CHECK(!path.over.empty());
    CHECK(path.over.front().engagement > 90.0 * kDegree);
    DOUBLES_EQUAL(6.1, path.over.front().slot_width.value_or(0.0), 1e-4);
    toolpath::OperationStats stats;
    EngagementReport report{60.0};
    report.add(path, 1);
    report.write(stats);
    STRCMP_CONTAINS("degrees at (", stats.warnings.front().c_str());
    STRCMP_CONTAINS("the slot is 6.1 mm wide, too narrow for trochoids",
                    stats.warnings.front().c_str());
    DOUBLES_EQUAL(3.01, least_x(path), 0.05);
}

double over(const AdaptivePath& path)
{
    double way = 0.0;
    for (const OverEngagement& place : path.over) {
        way += place.length;
    }
    return way;
}

// Only the last hundredths of corners are over.
TEST(AdaptiveClearing, TrochoidsOpenSlots)
{
    for (const double width : {6.2, 6.5, 7.0, 8.0, 9.0}) {
        const AdaptivePath path = clear_adaptively(rectangle(30, width), settings(60.0));
        CHECK(over(path) < 0.25);
        CHECK(path.engagement_bound <= 60.0 * kDegree);
        CHECK(path.left.empty());
        DOUBLES_EQUAL(3.01, least_x(path), 0.0063);  // thinner is no stock
    }
}

// Passes of larger radii come first where those along the walls would end in thick stock.
TEST(AdaptiveClearing, TheEndsOfCornersAreOneWarning)
{
    AdaptivePath path;
    path.over = {{{1, 2}, 82.0 * kDegree, 0.03}, {{3, 4}, 84.0 * kDegree, 0.02}};
    toolpath::OperationStats stats;
    EngagementReport report{60.0};
    report.add(path, 1);
    report.write(stats);
    LONGS_EQUAL(1, stats.warnings.size());
    STRCMP_EQUAL(
        "the engagement is up to 84 degrees, over max_engagement on less than 0.1 mm, at the "
        "end of 2 corners, such as at (3, 4) mm",
        stats.warnings.front().c_str());
}

TEST(AdaptiveClearing, CornersAreCutInThinSlices)
{
    const Region2d square{{{line_edge({0, 0}, {60, 6}), line_edge({60, 6}, {55, 50}),
                            line_edge({55, 50}, {-5, 44}), line_edge({-5, 44}, {0, 0})}}};
    const AdaptivePath wide = clear_adaptively(square, settings(42.0));
    CHECK(wide.engagement_bound <= 42.0 * kDegree);
    CHECK(over(wide) < 0.5);
    const Region2d kite{{{line_edge({0, 0}, {40, -12}), line_edge({40, -12}, {60, 0}),
                          line_edge({60, 0}, {40, 12}), line_edge({40, 12}, {0, 0})}}};
    const AdaptivePath sharp = clear_adaptively(kite, settings(60.0));
    CHECK(sharp.engagement_bound <= 60.0 * kDegree);
    CHECK(over(sharp) < 0.7);
}

// Links of more than `far` (mm).
int long_links(const AdaptivePath& path, double far)
{
    int found = 0;
    Vec2d at{};
    for (const AdaptiveRun& run : path.runs) {
        double way = 0.0;
        for (const LinkLeg& leg : run.link) {
            way += distance(at, leg.end);
            at = leg.end;
        }
        found += way > far ? 1 : 0;
        at = run.path.empty() ? run.helix->centre : run.path.back().end;
    }
    return found;
}

TEST(AdaptiveClearing, OneCornerIsFinishedBeforeTheNext)
{
    Contour star;
    const auto corner = [](int k) {
        const double angle = 36.0 * k * kDegree;
        return Vec2d{std::cos(angle), std::sin(angle)} * (k % 2 == 0 ? 38.0 : 17.0);
    };
    for (int k = 0; k < 10; ++k) {
        star.push_back(line_edge(corner(k), corner((k + 1) % 10)));
    }
    // Its tips are 45 mm apart and more. Four ways to each: along its walls, and for three turning
    // radii.
    CHECK(long_links(clear_adaptively(Region2d{{star}}, settings(60.0)), 25.0) <= 20);
}

// The stretch that the rounding leaves is shorter than half the way between two looks.
TEST(AdaptiveClearing, SharpCornersAreCutToTheirEnds)
{
    const Region2d kite{{{line_edge({0, 0}, {60, -28}), line_edge({60, -28}, {90, 0}),
                          line_edge({90, 0}, {60, 28}), line_edge({60, 28}, {0, 0})}}};
    AdaptiveSettings asked = settings(60.0);
    asked.tool_radius = 6.0;
    asked.wall_clearance = 6.01;
    const double end = asked.wall_clearance / std::sin(std::atan2(28.0, 60.0));
    CHECK(distance_to(clear_adaptively(kite, asked), {end, 0.0}) <= 2.0 * asked.corner);
}

TEST(AdaptiveClearing, TrochoidsOpenANeckFromARoom)
{
    const Region2d rooms{{{line_edge({0, 0}, {25, 0}), line_edge({25, 0}, {25, 11.5}),
                           line_edge({25, 11.5}, {50, 11.5}), line_edge({50, 11.5}, {50, 0}),
                           line_edge({50, 0}, {75, 0}), line_edge({75, 0}, {75, 30}),
                           line_edge({75, 30}, {50, 30}), line_edge({50, 30}, {50, 18.5}),
                           line_edge({50, 18.5}, {25, 18.5}), line_edge({25, 18.5}, {25, 30}),
                           line_edge({25, 30}, {0, 30}), line_edge({0, 30}, {0, 0})}}};
    const AdaptivePath path = clear_adaptively(rooms, settings(60.0));
    for (const OverEngagement& place : path.over) {
        CHECK(place.at.x < 24.0 || place.at.x > 51.0);
    }
    // The rooms are entered, the neck is not.
    LONGS_EQUAL(2, std::count_if(path.runs.begin(), path.runs.end(),
                                 [](const AdaptiveRun& run) { return run.helix.has_value(); }));
}

TEST(AdaptiveClearing, ATooLargeToolHasNoRuns)
{
    CHECK(clear_adaptively(rectangle(30, 5.9), settings(60.0)).runs.empty());
}

TEST(AdaptiveClearing, NoPassIsMadeTwice)
{
    AdaptiveSettings exact = settings(60.0);
    exact.wall_clearance = 3.005;
    exact.corner = 0.005;
    const AdaptivePath path = clear_adaptively(rectangle(90, 70), exact);
    int same = 0;
    for (std::size_t i = 0; i < path.runs.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const std::vector<Edge>& a = path.runs[i].path;
            const std::vector<Edge>& b = path.runs[k].path;
            same += !a.empty() && !b.empty() && distance(a.front().start, b.front().start) < 1e-6 &&
                            distance(a.back().end, b.back().end) < 1e-6
                        ? 1
                        : 0;
        }
    }
    LONGS_EQUAL(0, same);
}

// Each wall in one turn: so much of the way has its right side within a thin strip of a wall.
TEST(AdaptiveClearing, WallsAreCutOnce)
{
    const AdaptivePath path = clear_adaptively(rectangle(40, 30), settings(60.0));
    double beside = 0.0;
    for (const AdaptiveRun& run : path.runs) {
        for (const Edge& edge : run.path) {
            const Vec2d middle = point_on(edge, 0.5);
            const Vec2d heading = tangent_on(edge, 0.5);
            const Vec2d wall{std::min(middle.x, 40.0 - middle.x),
                             std::min(middle.y, 30.0 - middle.y)};
            beside += std::min(wall.x, wall.y) < 3.01 + 0.1 &&
                              std::max(std::abs(heading.x), std::abs(heading.y)) > 0.999
                          ? length(edge)
                          : 0.0;
        }
    }
    const double around = 2 * (40.0 + 30.0 - 4 * 3.01);
    CHECK(beside > 0.9 * around);
    CHECK(beside < 1.25 * around);
}

TEST(AdaptiveClearing, ConventionalIsTheMirrorImage)
{
    AdaptiveSettings other = settings(60.0);
    other.direction = job::CutDirection::kConventional;
    const AdaptivePath a = clear_adaptively(rectangle(24, 20), settings(60.0));
    const AdaptivePath b = clear_adaptively(rectangle(24, 20), other);
    CHECK(b.engagement_bound <= 60.0 * kDegree);
    // The first steered run turns the other way.
    LONGS_EQUAL(-a.runs[1].path.front().turn, b.runs[1].path.front().turn);
}

}  // namespace

}  // namespace cusp::test
