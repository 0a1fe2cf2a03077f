// Moves in random pockets with islands: entries, links, retracts, side of the
// cut, layers, allowance, one tool or two.
#include <cstdio>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/judges/moves_judge.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace job;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

constexpr unsigned kSeed = 1990;
constexpr double kGrain = 1e-3;  // mm

struct RandomTask {
    Region2d region;
    Job job;
    Operation operation;
};

Curve curve_of(const Edge& edge)
{
    const Vec3d a{edge.start.x, edge.start.y, 0.0};
    const Vec3d b{edge.end.x, edge.end.y, 0.0};
    if (edge.turn == 0) {
        return {1, {0.0, 0.0, 1.0, 1.0}, {a, b}, {1.0, 1.0}};
    }
    const double half = sweep(edge) / 2;
    const Vec2d middle = (edge.start + edge.end) * 0.5;
    const Vec2d out = unit(middle - edge.centre) * (edge.radius / std::cos(half));
    const Vec2d corner = edge.centre + out;
    return {2,
            {0.0, 0.0, 0.0, 1.0, 1.0, 1.0},
            {a, {corner.x, corner.y, 0.0}, b},
            {1.0, std::cos(half), 1.0}};
}

Loop loop_of(const Contour& contour)
{
    Loop loop;
    for (const Edge& edge : contour) {
        loop.push_back(curve_of(edge));
    }
    return loop;
}

Tool random_tool(Random& random, int number, double radius)
{
    const auto shape = static_cast<ToolShape>(static_cast<int>(uniform(random, 0.0, 2.999)));
    const double corner = shape == ToolShape::kBall   ? radius
                          : shape == ToolShape::kFlat ? 0.0
                                                      : uniform(random, 0.2, 0.6) * radius;
    return {number, shape, radius, corner};
}

RandomTask random_task(Random& random)
{
    RandomTask task;
    const auto one_of = [&](int count) {
        return static_cast<int>(uniform(random, 0.0, count - 1e-9));
    };
    task.region = random_region(random);
    task.job.file = "job";
    task.job.stock_top = uniform(random, 0.0, 3.0);
    task.job.clearance = uniform(random, 2.0, 8.0);
    task.job.feed = 1200;
    task.job.plunge_feed = 300;
    Operation& operation = task.operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    const double depth = uniform(random, 5.0, 10.0);
    const double rough = one_of(2) * uniform(random, 0.5, 3.0);
    operation.part.floor = {random_floor(random, {-80.0, -80.0, 80.0, 80.0}, -depth, rough)};
    operation.part.floor_files = {"floor"};
    operation.outline.boundary = loop_of(task.region.contours.front());
    operation.outline.boundary_file = "boundary";
    for (std::size_t i = 1; i < task.region.contours.size(); ++i) {
        operation.outline.islands.push_back(loop_of(task.region.contours[i]));
        operation.outline.island_files.push_back("island");
    }
    const double radius = uniform(random, 3.5, 6.0);
    operation.tool = random_tool(random, 1, radius);
    operation.tools = {operation.tool};
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.side = one_of(3) == 0 ? ToleranceSide::kBoth : ToleranceSide::kOutside;
    operation.tolerance.scallop = 0.3;
    operation.output = one_of(2) == 0 ? OutputForm::kLines : OutputForm::kArcs;
    operation.passes.direction_of_cut = static_cast<CutDirection>(one_of(2));
    operation.passes.entry = static_cast<EntryKind>(one_of(4));
    if (one_of(2) == 0) {
        operation.passes.allowance = one_of(2) * uniform(random, 0.1, 0.5);
        operation.levels.max_depth = uniform(random, 2.0, 5.0);
        if (one_of(2) == 0) {
            operation.tools = {random_tool(random, 2, radius * uniform(random, 0.8, 1.5)),
                               operation.tool};
        }
    }
    return task;
}

// Plates in steps over the floor, some rotated or beside walls, so that passes run along cliffs.
RandomTask random_task_with_cliffs(Random& random)
{
    RandomTask task = random_task(random);
    Operation& operation = task.operation;
    const double low = operation.part.floor.front().points.front().z;
    const int plates = whole(random, 2, 4);
    for (int i = 0; i < plates; ++i) {
        const double angle = uniform(random, 0.0, 3.0);
        operation.part.floor.push_back(
            turned_plate({uniform(random, -45.0, 45.0), uniform(random, -45.0, 45.0)},
                         {std::cos(angle), std::sin(angle)}, uniform(random, 10.0, 40.0),
                         uniform(random, 5.0, 25.0), low + uniform(random, 0.5, 4.0)));
    }
    return task;
}

double counted(const OperationStats& stats, const char* name)
{
    const auto found = std::find_if(stats.counts.begin(), stats.counts.end(),
                                    [&](const auto& count) { return count.first == name; });
    return found == stats.counts.end() ? 0.0 : found->second;
}

bool warned(const PlannedOperation& planned)
{
    const auto& warnings = planned.stats.warnings;
    return std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) {
        return text.find("no room for a slope") != std::string::npos;
    });
}

// mm: how far the stock left is below the allowance over the floor.
double under(const MovesJudge& judge, const Surface& floor, double allowance)
{
    constexpr int kEach = 200;
    double most = -1e300;
    for (int i = 0; i <= kEach; ++i) {
        for (int j = 0; j <= kEach; ++j) {
            const Vec3d p =
                point_at(floor, static_cast<double>(i) / kEach, static_cast<double>(j) / kEach);
            most = std::max(most, p.z + allowance - judge.height({p.x, p.y}));
        }
    }
    return most;
}

void check_retracts(const OperationStats& stats)
{
    const double each = counted(stats, "leaves") + counted(stats, "islands");
    CHECK(stats.retracts <= each * std::max(1.0, counted(stats, "layers")));
}

void check_moves(const RandomTask& task,
                 const PlannedOperation& planned,
                 const MovesVerdict& verdict)
{
    const Operation& operation = task.operation;
    const OperationStats& stats = planned.stats;
    CHECK(!verdict.low_rapid);
    CHECK(verdict.rapid_cut <= 0.05);
    if (operation.passes.entry != EntryKind::kPlunge && !warned(planned)) {
        CHECK(verdict.plunged <= 0.05);
        // If the floor is steeper than a slope down, slopes follow it.
        CHECK(verdict.entry_cut <= 0.3);
    }
    LONGS_EQUAL(stats.retracts, verdict.retracts);
    LONGS_EQUAL(operation.outline.islands.size(), counted(stats, "islands"));
    check_retracts(stats);
    CHECK(verdict.wrong_side <= 0.3 * (verdict.right_side + verdict.wrong_side) + 50.0);
    CHECK(verdict.deepest <= operation.levels.max_depth.value_or(1e300) * 1.02 + 0.03);
}

struct LinkCount {
    int all{};
    int turned{};
};

LinkCount judge_task(const RandomTask& task, const std::vector<PlannedOperation>& planned)
{
    const Operation& operation = task.operation;
    const double largest = std::max(operation.tool.radius, operation.tools.front().radius);
    const double smallest = std::min(operation.tool.radius, operation.tools.front().radius);
    LinkCount links;
    MovesJudge judge{task.region, task.job.stock_top, smallest, largest};
    for (const PlannedOperation& one : planned) {
        const bool rough = one.stats.roughing;
        const Tool& tool = rough ? operation.tools.front() : operation.tool;
        LONGS_EQUAL(tool.number, one.path.tool.number);
        const MovesVerdict verdict =
            judge.cut(one.path, task.job.stock_top + task.job.clearance,
                      operation.passes.direction_of_cut == CutDirection::kClimb);
        links.all += verdict.links;
        links.turned += verdict.turned;
        const double allowance = rough ? operation.passes.allowance : 0.0;
        const bool both = operation.tolerance.side == ToleranceSide::kBoth;
        const double past = both ? operation.tolerance.plan : 0.0;
        std::printf(
            "  tool %d: rapid %.3f plunged %.3f entry %.3f deepest %.3f retracts %d of "
            "%.0f + %.0f, wrong side %.0f of %.0f\n",
            tool.number, verdict.rapid_cut, verdict.plunged, verdict.entry_cut, verdict.deepest,
            verdict.retracts, counted(one.stats, "leaves"), counted(one.stats, "islands"),
            verdict.wrong_side, verdict.wrong_side + verdict.right_side);
        check_moves(task, one, verdict);
        CHECK(verdict.nearest_wall >= tool.radius + allowance - past - kGrain);
        CHECK(under(judge, operation.part.floor.front(), allowance) <= past + 2 * kGrain);
    }
    return links;
}

// Nothing where the tool fits nowhere.
std::vector<PlannedOperation> planned_or_too_narrow(const RandomTask& task)
{
    try {
        return plan_contour_pocket(task.job, task.operation);
    } catch (const InputError& error) {
        CHECK(std::string{error.what()}.find("fits nowhere") != std::string::npos);
        return {};
    }
}

TEST_GROUP(PocketPathWriter){};

TEST(PocketPathWriter, EnterGentlyLinkThroughCutMetalAndKeepSideDepthAndAllowance)
{
    Random random{kSeed};
    LinkCount links;
    for (int i = 0; i < property_cases(6); ++i) {
        const RandomTask task = random_task(random);
        std::printf("seed %u pocket %d\n", kSeed, i);
        const std::vector<PlannedOperation> planned = planned_or_too_narrow(task);
        const LinkCount some = judge_task(task, planned);
        links.all += some.all;
        links.turned += some.turned;
    }
    std::printf("%d links, %d end on a corner\n", links.all, links.turned);
    // Links over the stock that end at the pass itself.
    constexpr double kFew = 2.0;
    CHECK(links.turned <= 0.01 * links.all + kFew);
}

// Passes cross the edges of cliffs into the stock at their feet.
TEST(PocketPathWriter, TakeNoMoreRetractsForCliffsAndGoDownThemNoFasterThanThePlungeFeed)
{
    constexpr unsigned kCliffSeed = 1991;
    constexpr double kRidge = 0.06;  // of the radius: stock between passes
    int descents = 0;
    Random random{kCliffSeed};
    for (int i = 0; i < property_cases(8); ++i) {
        const RandomTask task = random_task_with_cliffs(random);
        const std::vector<PlannedOperation> planned = planned_or_too_narrow(task);
        const double smallest =
            std::min(task.operation.tool.radius, task.operation.tools.front().radius);
        const double largest =
            std::max(task.operation.tool.radius, task.operation.tools.front().radius);
        MovesJudge judge{task.region, task.job.stock_top, smallest, largest};
        for (const PlannedOperation& one : planned) {
            const MovesVerdict verdict =
                judge.cut(one.path, task.job.stock_top + task.job.clearance,
                          task.operation.passes.direction_of_cut == CutDirection::kClimb);
            std::printf(
                "seed %u cliffs %d: %.0f passes along them, retracts %d of %.0f + %.0f, "
                "rapid %.3f, deepest %.3f, sunk %.3f\n",
                kCliffSeed, i, counted(one.stats, "cliff_passes"), verdict.retracts,
                counted(one.stats, "leaves"), counted(one.stats, "islands"), verdict.rapid_cut,
                verdict.deepest, verdict.sunk);
            LONGS_EQUAL(one.stats.retracts, verdict.retracts);
            check_retracts(one.stats);
            CHECK(!verdict.low_rapid);
            CHECK(verdict.rapid_cut <= 0.05);
            CHECK(verdict.sunk <= kRidge * one.path.tool.radius);
            descents += static_cast<int>(std::count_if(
                one.path.moves.begin(), one.path.moves.end(),
                [](const ToolMove& move) { return move.kind == MoveKind::kPlungingCut; }));
            CHECK(verdict.deepest <= task.operation.levels.max_depth.value_or(1e300) * 1.02 + 0.03);
        }
    }
    CHECK(descents > 0);
}

}  // namespace
}  // namespace cusp::test
