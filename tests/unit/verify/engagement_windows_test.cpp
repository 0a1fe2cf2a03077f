// A closer look at what a coarse height map finds over the limit.
#include "host_tools/judge/verify/engagement_windows.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/judge/verify/engagement.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"

using namespace cusp;
using namespace cusp::verify;

namespace {

constexpr double kSpacing = 0.1;
constexpr double kRadius = 3.0;
constexpr double kMiddle = 6.0;  // y of slots
constexpr double kLimit = 60.0;  // degrees

ToolPositions run() { return {{1, toolpath::ToolShape::kFlat, kRadius, 0.0}, {}, {}, {}}; }

void go_to(ToolPositions& out, Vec2d to)
{
    const Vec2d from = out.tips.empty() ? to : in_plan(out.tips.back());
    const int steps = 1 + static_cast<int>(norm(to - from) / kSpacing);
    for (int k = 1; k <= steps; ++k) {
        const Vec2d p = from + (to - from) * (static_cast<double>(k) / steps);
        out.tips.push_back({p.x, p.y, -5.0});
        out.rapid.push_back(false);
        out.lines.push_back(1);
    }
}

// Turns of radius 0.5 into the stock, which begins at x = 0, each so far ahead of the one before.
ToolPositions trochoids(double advance)
{
    ToolPositions out = run();
    for (double x = -3.5; x < 8.0; x += advance) {
        for (int k = 0; k <= 36; ++k) {
            const double angle = -2 * 3.14159265358979 * k / 36;
            go_to(out, {x + 0.5 * std::cos(angle), kMiddle + 0.5 * std::sin(angle)});
        }
    }
    return out;
}

ToolPositions slot(double length)
{
    ToolPositions out = run();
    go_to(out, {-8.0, kMiddle});
    go_to(out, {length, kMiddle});
    return out;
}

job::Job stock_of_a_test()
{
    job::Job job;
    job.file = "job.toml";
    return job;
}

// mm over the limit
struct Way {
    double before;  // by the height map
    double after;
    double fine;  // by a height map that is as fine as the windows
};

double over(const ToolPositions& positions, const EngagementRun& found)
{
    EngagementFigures figures;
    add_engagement(positions, kLimit, found, figures);
    return figures.over_length.value_or(0.0);
}

EngagementRun traced(const ToolPositions& positions, const HeightGrid& grid)
{
    MachinedStock stock{grid, 0.0};
    EngagementTrace trace{grid, positions};
    stock.cut(
        positions, kSpacing, [](double) {}, &trace);
    return trace.finish();
}

Way looked_at(const ToolPositions& positions)
{
    const HeightGrid grid{0.0, -4.0, 0.173, 170, 115, true};
    std::vector<EngagementRun> found{traced(positions, grid)};
    set_limit(positions.tool, kLimit, grid.pitch, found[0]);
    Way way{over(positions, found[0]), 0.0, 0.0};
    look_closer(stock_of_a_test(), grid, kSpacing, {positions}, found);
    way.after = over(positions, found[0]);
    EngagementRun fine = traced(positions, {0.0, -4.0, 0.02, 1470, 1000, true});
    fine.counts_over = found[0].counts_over;
    way.fine = over(positions, fine);
    return way;
}

}  // namespace

TEST_GROUP(EngagementWindows){};

TEST(EngagementWindows, FindWhatAFineHeightMapFinds)
{
    for (const double advance : {0.15, 0.2, 0.3}) {
        const Way way = looked_at(trochoids(advance));
        CHECK(way.after < 0.5 * way.before);
        DOUBLES_EQUAL(way.fine, way.after, 0.05 * way.before);
    }
}

TEST(EngagementWindows, ASlotStaysOver)
{
    const Way way = looked_at(slot(28.0));
    CHECK(way.before > 26.0);
    DOUBLES_EQUAL(way.before, way.after, 0.5);
}
