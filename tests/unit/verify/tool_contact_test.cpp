// Contacts of random discs along random paths against a raster that is cut in time order, and looked at
// point by point; then what a job's lengths make of a tool.
#include "host_tools/judge/verify/tool_contact.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/judge/verify/machined_stock.hpp"
#include "tests/support/leaks_on_threads.hpp"

using namespace cusp;
using namespace cusp::verify;

namespace {

constexpr double kSpacing = 0.4;

// The tool is flat and moves level or straight down, so that what it cuts between two positions is the
// places within its radius of the way.
class RasterCutter {
public:
    RasterCutter(const HeightGrid& grid, double top) : grid_{grid}, heights_(grid.size(), top) {}

    double depth(Vec3d tip, const ToolDisc& disc) const
    {
        double deepest = 0;
        for_each_point([&](std::size_t k, Vec2d p) {
            const double dx = p.x - tip.x;
            const double dy = p.y - tip.y;
            if (dx * dx + dy * dy <= disc.radius * disc.radius) {
                deepest = std::max(deepest, heights_[k] - (tip.z + disc.above));
            }
        });
        return deepest > disc.slack ? deepest : 0;
    }

    void cut(double radius, Vec3d from, Vec3d to)
    {
        const double x = to.x - from.x;
        const double y = to.y - from.y;
        const double squared = x * x + y * y;
        for_each_point([&](std::size_t k, Vec2d p) {
            const double along = (p.x - from.x) * x + (p.y - from.y) * y;
            const double share = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
            const double dx = p.x - from.x - share * x;
            const double dy = p.y - from.y - share * y;
            if (dx * dx + dy * dy <= radius * radius) {
                heights_[k] = std::min(heights_[k], std::min(from.z, to.z));
            }
        });
    }

private:
    template <class Visit>
    void for_each_point(const Visit& visit) const
    {
        for (std::size_t i = 0; i < grid_.nx; ++i) {
            for (std::size_t j = 0; j < grid_.ny; ++j) {
                visit(grid_.index(i, j), Vec2d{grid_.x(i, j), grid_.y(i, j)});
            }
        }
    }

    HeightGrid grid_;
    std::vector<double> heights_;
};

class RandomNumbers {
public:
    explicit RandomNumbers(unsigned seed) : engine_{seed} {}
    double between(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(engine_);
    }

private:
    std::mt19937 engine_;
};

void append_way(ToolPositions& positions, Vec3d to)
{
    const Vec3d from = positions.tips.empty() ? to : positions.tips.back();
    const int steps = std::max(1, static_cast<int>(std::ceil(norm(to - from) / kSpacing)));
    for (int i = 1; i <= steps; ++i) {
        positions.tips.push_back(from + (static_cast<double>(i) / steps) * (to - from));
        positions.rapid.push_back(false);
        positions.lines.push_back(1);
    }
}

// Level moves, and up and down between them.
ToolPositions random_path(RandomNumbers& random, const HeightGrid& grid, double radius)
{
    ToolPositions positions{{1, toolpath::ToolShape::kFlat, radius, 0}, {}, {}, {}};
    const double width = static_cast<double>(grid.nx) * grid.pitch;
    Vec3d at{width / 2, width / 2, 1};
    append_way(positions, at);
    for (int n = 0; n < 60; ++n) {
        at.z = n % 3 == 0 ? random.between(-12, 1) : at.z;
        append_way(positions, at);
        const double x = random.between(0, width);
        const double y = random.between(0, width);
        const double share = random.between(0.05, 0.6);
        at.x += share * (x - at.x);
        at.y += share * (y - at.y);
        append_way(positions, at);
    }
    return positions;
}

StockExtent nothing_around() { return {{-kUnbounded, kUnbounded}, {-kUnbounded, kUnbounded}, 0}; }

}  // namespace

TEST_GROUP(ToolContact)
{
    job::Job job;
    toolpath::Tool tool{1, toolpath::ToolShape::kFlat, 3, 0};

    void setup() override { job.tools = {tool}; }

    job::ToolFacts& facts() { return job.tool_facts[1]; }

    void expect_as_by_raster(unsigned seed)
    {
        RandomNumbers random{seed};
        const HeightGrid grid{0, 0, random.between(0.4, 0.9), 60, 57, true};
        const ToolPositions positions = random_path(random, grid, random.between(1, 3));
        std::vector<ToolDisc> discs;
        for (const BodyPart part :
             {BodyPart::kBeyondFlutes, BodyPart::kShank, BodyPart::kHolder, BodyPart::kHolder}) {
            const double radius = random.between(0.5, 14);
            const double above = random.between(-0.5, 13);
            discs.push_back({part, radius, above, random.between(0.001, 0.5)});
        }
        MachinedStock stock{grid, 0};
        ContactTrace trace{grid, positions, discs, nothing_around()};
        stock.cut(
            positions, kSpacing, [](double) {}, nullptr, &trace);
        const std::vector<BodyContact> found = trace.finish();

        RasterCutter raster{grid, 0};
        std::vector<std::vector<double>> depths(discs.size());
        for (std::size_t k = 0; k < positions.tips.size(); ++k) {
            for (std::size_t d = 0; d < discs.size(); ++d) {
                depths[d].push_back(raster.depth(positions.tips[k], discs[d]));
            }
            raster.cut(positions.tool.radius, positions.tips[k > 0 ? k - 1 : 0], positions.tips[k]);
        }
        CHECK_EQUAL(discs.size(), found.size());
        for (std::size_t d = 0; d < discs.size(); ++d) {
            const double deepest = *std::max_element(depths[d].begin(), depths[d].end());
            DOUBLES_EQUAL(deepest, found[d].depth, 1e-12);
            DOUBLES_EQUAL(deepest, depths[d][found[d].position], 1e-12);
        }
    }
};

TEST(ToolContact, IsThatOfARasterCutInTimeOrder)
{
    for (unsigned seed = 1; seed <= 12; ++seed) {
        expect_as_by_raster(seed);
    }
}

TEST(ToolContact, OfAHolderOverAWallIsTheWallsHeightOverItsFace)
{
    facts().length = 10;
    facts().holder = {{8, 5}, {20, 10}};
    const HeightGrid grid{0, 0, 0.173, 200, 200, true};
    ToolPositions positions{tool, {}, {}, {}};
    append_way(positions, {17, 17, 1});
    append_way(positions, {17, 17, -17});
    MachinedStock stock{grid, 0};
    ContactTrace trace{grid, positions, tool_discs(job, tool), nothing_around()};
    stock.cut(
        positions, kSpacing, [](double) {}, nullptr, &trace);
    const std::vector<BodyContact> found = trace.finish();
    CHECK_EQUAL(2U, found.size());
    DOUBLES_EQUAL(7.5, found[0].depth, 1e-9);  // 17 - 10, and the clearance
    DOUBLES_EQUAL(2.5, found[1].depth, 1e-9);
    DOUBLES_EQUAL(17.5, long_enough(job, tool, found[0]), 1e-9);
}

TEST(ToolContact, NeedsLengthsOfTheTool)
{
    CHECK(tool_discs(job, tool).empty());
    facts().length = 10;
    CHECK(tool_discs(job, tool).empty());
    facts().flute_length = 8;
    CHECK_EQUAL(1U, tool_discs(job, tool).size());
    facts().shank_diameter = 6;  // where the cutter has been
    CHECK_EQUAL(1U, tool_discs(job, tool).size());
    facts().shank_diameter = 6.1;
    CHECK_EQUAL(2U, tool_discs(job, tool).size());
    facts().holder = {{20, 5}, {10, 5}, {30, 5}};  // the second is in the shadow of the first
    const std::vector<ToolDisc> discs = tool_discs(job, tool);
    CHECK_EQUAL(4U, discs.size());
    DOUBLES_EQUAL(3.55, discs[1].radius, 1e-12);
    DOUBLES_EQUAL(7.5, discs[1].above, 1e-12);
    DOUBLES_EQUAL(10.5, discs[2].radius, 1e-12);
    DOUBLES_EQUAL(9.5, discs[2].above, 1e-12);
    DOUBLES_EQUAL(19.5, discs[3].above, 1e-12);
}

// A vee of 90 degrees, 10 mm high, cuts beyond its flutes only with its cone.
TEST(ToolContact, OfAConeThatIsHigherThanItsFlutes)
{
    toolpath::Tool vee{1, toolpath::ToolShape::kVee, 10, 0};
    vee.tip_angle = 1.5707963267948966;
    job.tools = {vee};
    facts().flute_length = 4;
    const HeightGrid grid{0, 0, 0.173, 200, 200, true};
    const auto depth = [&](double z, double radius) {
        MachinedStock stock{grid, 0};
        const ToolPositions hole{
            {2, toolpath::ToolShape::kFlat, radius, 0}, {{17, 17, -20}}, {false}, {1}};
        stock.cut(hole, kSpacing, [](double) {});
        const ToolPositions positions{vee, {{17, 17, z}}, {false}, {1}};
        ContactTrace trace{grid, positions, tool_discs(job, vee), nothing_around()};
        stock.cut(
            positions, kSpacing, [](double) {}, nullptr, &trace);
        double deepest = 0;
        for (const BodyContact& contact : trace.finish()) {
            deepest = std::max(deepest, contact.depth);
        }
        return deepest;
    };
    DOUBLES_EQUAL(2, depth(-6, 2), 1e-9);
    DOUBLES_EQUAL(0, depth(-4, 2), 1e-9);
    DOUBLES_EQUAL(0, depth(-9, 9.3), 1e-9);  // the hole is wider than the cone at the stock's top
    DOUBLES_EQUAL(8, depth(-12, 9.3), 1e-9);
}

TEST(ToolContact, ThereIsStockAroundAPocketUnlessTheJobGivesItsExtent)
{
    const HeightGrid grid{0, 0, 1, 20, 20, false};
    job::Strategy clearing_walls;
    clearing_walls.traits.pocket = true;
    job::Operation pocket;
    pocket.strategy = &clearing_walls;
    pocket.outline.boundary.emplace();
    job.operations = {pocket};
    DOUBLES_EQUAL(-0.5, stock_around(job, grid).x[0], 1e-12);
    DOUBLES_EQUAL(20.5, stock_around(job, grid).y[1], 1e-12);
    facts().length = 10;
    facts().holder = {{22, 5}};
    MachinedStock stock{grid, 0};
    ToolPositions clearing{{2, toolpath::ToolShape::kFlat, 30, 0}, {{10, 10, -20}}, {false}, {1}};
    stock.cut(clearing, kSpacing, [](double) {});
    ToolPositions positions{tool, {{10, 10, -12}}, {false}, {1}};
    const auto contact = [&] {
        ContactTrace trace{grid, positions, tool_discs(job, tool), stock_around(job, grid)};
        stock.cut(
            positions, kSpacing, [](double) {}, nullptr, &trace);
        return trace.finish().front().depth;
    };
    DOUBLES_EQUAL(2.5, contact(), 1e-12);
    job.stock_x = job.stock_y = {-0.5, 19.5};
    DOUBLES_EQUAL(0, contact(), 1e-12);
    job.stock_y.reset();
    DOUBLES_EQUAL(2.5, contact(), 1e-12);
    job.operations.push_back({});  // without a boundary: the stock may end where the part does
    DOUBLES_EQUAL(0, contact(), 1e-12);
}
