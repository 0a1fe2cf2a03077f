// A wall with a window and an arch is divided into pieces that vertical lines cross once.
#include "host_tools/cam/finishing/column_outlines.hpp"

#include <cmath>

#include "firmware/base/math.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;

namespace {

double area_of(const std::vector<Outline>& outlines)
{
    double sum = 0;
    for (const Outline& outline : outlines) {
        double twice = 0;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const Vec2d a = outline[k];
            const Vec2d b = outline[(k + 1) % outline.size()];
            twice += a.x * b.y - a.y * b.x;
        }
        sum += 0.5 * std::abs(twice);
    }
    return sum;
}

// Number of crossings of the outline and a vertical line.
int crossings(const Outline& outline, double x)
{
    int count = 0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const double a = outline[k].x;
        const double b = outline[(k + 1) % outline.size()].x;
        count += (a < x) != (b < x) ? 1 : 0;
    }
    return count;
}

Outline box(Vec2d low, Vec2d high) { return {low, {high.x, low.y}, high, {low.x, high.y}}; }

}  // namespace

TEST_GROUP(ColumnOutlines){};

TEST(ColumnOutlines, DividesRoundAWindow)
{
    const std::vector<Outline> out =
        column_outlines({box({0, 0}, {10, 5}), box({3, 1}, {6, 4})}, 100, 64);
    LONGS_EQUAL(4, out.size());
    DOUBLES_EQUAL(50 - 9, area_of(out), 1e-9);
}

TEST(ColumnOutlines, CrossesEachColumnOnce)
{
    Outline arch{{10, 0}, {0, 0}, {0, 4}};
    for (int k = 0; k <= 40; ++k) {
        const double turn = kPi * k / 40;
        arch.push_back({5 - 4 * std::cos(turn), 4 - 3 * std::sin(turn)});
    }
    arch.push_back({10, 4});
    const std::vector<Outline> out =
        column_outlines({arch, box({2, 0.25}, {8, 0.5}), box({4, 0.6}, {5, 0.8})}, 3, 20);
    double whole = area_of({arch}) - 6 * 0.25 - 0.2;
    DOUBLES_EQUAL(whole, area_of(out), 1e-6);
    for (const Outline& outline : out) {
        CHECK(outline.size() <= 24);
        for (double x = 0.013; x < 10; x += 0.1) {
            CHECK(crossings(outline, x) <= 2);
        }
    }
}

// Loops clipped to a cell run along its border and back.
TEST(ColumnOutlines, TakesSidesThatLieTwiceForNone)
{
    const Outline two{{0, 0}, {1, 0}, {1, 3}, {0, 3}, {0, 2}, {-0.0, 1}};
    const Outline back{{0, 0}, {4, 0}, {4, 2}, {3, 0}, {2, 0}, {1, 2}};
    DOUBLES_EQUAL(3, area_of(column_outlines({two}, 100, 64)), 1e-9);
    DOUBLES_EQUAL(area_of({{{0, 0}, {2, 0}, {1, 2}}, {{3, 0}, {4, 0}, {4, 2}}}),
                  area_of(column_outlines({back}, 100, 64)), 1e-9);
}

TEST(ColumnOutlines, SimplifiesWithinTheDistance)
{
    Outline circle;
    for (int k = 0; k < 400; ++k) {
        circle.push_back({std::cos(kPi * k / 200), std::sin(kPi * k / 200)});
    }
    const Outline fewer = simplified(circle, 1e-3);
    CHECK(fewer.size() < 90);
    DOUBLES_EQUAL(area_of({circle}), area_of({fewer}), kPi * 2e-3);
}
