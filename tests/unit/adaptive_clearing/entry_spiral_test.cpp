// The hole of an entry is widened within the engagement; without stock in the way it is whole.
#include "host_tools/cam/adaptive_clearing/entry_spiral.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

namespace {

constexpr double kDegrees = 3.14159265358979323846 / 180.0;

struct Spiral {
    SweptArea swept{{-10, -10, 10, 10}, 3.0};
    EntrySpiral found;
    Spiral(double radius, double degrees)
        : found{entry_spiral(swept, {1, 2}, radius, {degrees * kDegrees, 0.002})}
    {
    }
};

TEST_GROUP(EntrySpirals){};

TEST(EntrySpirals, BeginInTheCentreAndEndInACircle)
{
    const Spiral spiral{0.9, 60.0};
    const std::vector<Edge>& path = spiral.found.path;
    DOUBLES_EQUAL(0.0, distance({1, 2}, path.front().start), 1e-12);
    DOUBLES_EQUAL(0.9, spiral.found.radius, 1e-12);
    DOUBLES_EQUAL(0.0, distance({1, 2}, path.back().centre), 1e-12);
    DOUBLES_EQUAL(0.9, path.back().radius, 1e-12);
    for (std::size_t i = 1; i < path.size(); ++i) {
        DOUBLES_EQUAL(0.0, distance(path[i - 1].end, path[i].start), 1e-12);
        DOUBLES_EQUAL(1.0, dot(tangent_at_end(path[i - 1]), tangent_at_start(path[i])), 1e-12);
    }
}

TEST(EntrySpirals, KeepTheEngagementAfterTheFirstTurn)
{
    for (const double degrees : {20.0, 35.0, 60.0, 100.0, 150.0}) {
        const Spiral spiral{0.9, degrees};
        CHECK(spiral.found.engagement_bound <= degrees * kDegrees);
        // The bound that was returned is that of the path, cut again.
        SweptArea swept{{-10, -10, 10, 10}, 3.0};
        swept.add_disc({1, 2}, 3.0);
        double first = 0.0;
        for (std::size_t i = 0; i < spiral.found.path.size(); ++i) {
            const Edge& edge = spiral.found.path[i];
            const double bound = swept.engagement_bound(edge, degrees * kDegrees, 0.002);
            if (i < kFirstTurnEdges) {
                first = std::max(first, bound);
            } else {
                CHECK(bound <= degrees * kDegrees);
            }
            swept.add(edge, 0.002);
        }
        CHECK(first > 85.0 * kDegrees);
    }
}

TEST(EntrySpirals, AreWholeAtTheRadiusThatTheyReach)
{
    for (const double radius : {0.1, 0.15, 0.2, 0.28, 0.29, 0.3, 0.35, 0.5}) {
        const EntrySpiral found = Spiral{radius, 60.0}.found;
        if (found.radius < radius) {
            continue;
        }
        for (int i = 0; i < 720; ++i) {
            const Vec2d way{std::cos(i * 0.5 * kDegrees), std::sin(i * 0.5 * kDegrees)};
            double nearest = 1.0;
            for (const Edge& edge : found.path) {
                nearest = std::min(nearest, distance_to(edge, Vec2d{1, 2} + way * radius));
            }
            CHECK(nearest <= 0.0002);
        }
    }
}

TEST(EntrySpirals, SweepTheWholeHole)
{
    const Spiral spiral{0.9, 60.0};
    for (int i = 0; i < 720; ++i) {
        const Vec2d at = Vec2d{std::cos(i * 0.5 * kDegrees), std::sin(i * 0.5 * kDegrees)};
        CHECK(spiral.swept.contains(Vec2d{1, 2} + at * 3.89));
        CHECK(!spiral.swept.contains(Vec2d{1, 2} + at * 3.91));
    }
}

// By the path alone.
TEST(EntrySpirals, CutTheWholeHoleHoweverFastTheyGrow)
{
    for (const double degrees : {40.0, 60.0, 80.0, 100.0, 150.0}) {
        const Spiral spiral{0.9, degrees};
        SweptArea swept{{-10, -10, 10, 10}, 3.0};
        for (const Edge& edge : spiral.found.path) {
            swept.add(edge, 0.002);
        }
        for (int i = 0; i < 720; ++i) {
            const Vec2d at = Vec2d{std::cos(i * 0.5 * kDegrees), std::sin(i * 0.5 * kDegrees)};
            CHECK(swept.contains(Vec2d{1, 2} + at * (3.0 + spiral.found.radius - 0.02)));
        }
    }
}

TEST(EntrySpirals, OfAHoleWithHardlyRoomAreAFirstTurnAlone)
{
    for (const double radius : {0.03, 0.06, 0.12}) {
        const Spiral spiral{radius, 60.0};
        DOUBLES_EQUAL(radius, spiral.found.radius, 1e-12);
        LONGS_EQUAL(kFirstTurnEdges, spiral.found.path.size());
        DOUBLES_EQUAL(0.0, spiral.found.engagement_bound, 1e-12);
    }
}

TEST(EntrySpirals, OfCoarseChordsKeepTheEngagementToo)
{
    for (const double degrees : {10.0, 35.0, 60.0, 100.0}) {
        SweptArea swept{{-4, -4, 4, 4}, 1.0};
        const EntrySpiral found = entry_spiral(swept, {0, 0}, 0.3, {degrees * kDegrees, 0.01});
        CHECK(found.engagement_bound <= degrees * kDegrees);
        CHECK(found.radius > 0.1 && found.radius <= 0.3);
    }
}

}  // namespace

}  // namespace cusp::test
