// Finishing with every end, judged by brute force: samples of the part against all tips and the profile
// of the tool alone.
#include <algorithm>
#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"
#include "host_tools/cam/steep_shallow/steep_shallow.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/unit/adaptive_isocurve/small_models.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::steep_shallow;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr double kScallopLeft = 0.1;
constexpr double kBand = 0.03;
constexpr double kWideBand = 0.08;
constexpr double kBetweenTips = 0.003;  // mm: what tips a tenth of a millimetre apart leave

// A hill with a level top of radius 2 and a side of 60 degrees, 3 mm high, on a level square of 12 mm.
constexpr double kTop = 2;
constexpr double kDeep = 3;
constexpr double kSquareHalf = 6;
constexpr int kAround = 24;

Vec3d on_hill(double turn, double down)
{
    // On the facets, which are inside of the cone.
    const double part = 2 * kPi / kAround;
    const double from_middle = std::remainder(turn - 0.5 * part, part);
    const double away =
        (kTop + down / std::tan(kPi / 3)) * std::cos(0.5 * part) / std::cos(from_middle);
    return {away * std::cos(turn), away * std::sin(turn), -down};
}

std::vector<std::array<Vec3d, 3>> small_hill()
{
    std::vector<std::array<Vec3d, 3>> out;
    const auto at = [](int k, double down) {
        const double turn = 2 * kPi * k / kAround;
        const double away = kTop + down / std::tan(kPi / 3);
        return Vec3d{away * std::cos(turn), away * std::sin(turn), -down};
    };
    const auto rim = [](int k) {
        const double turn = 2 * kPi * k / kAround;
        const double reach =
            kSquareHalf / std::max(std::abs(std::cos(turn)), std::abs(std::sin(turn)));
        return Vec3d{reach * std::cos(turn), reach * std::sin(turn), -kDeep};
    };
    for (int k = 0; k < kAround; ++k) {
        const Vec3d a = at(k, 0), b = at(k + 1, 0), c = at(k, kDeep), d = at(k + 1, kDeep);
        out.push_back({Vec3d{0, 0, 0}, a, b});
        out.push_back({a, c, d});
        out.push_back({a, d, b});
        out.push_back({c, rim(k), rim(k + 1)});
        out.push_back({c, rim(k + 1), d});
    }
    return out;
}

std::vector<Tool> small_ends()
{
    Tool taper{3, ToolShape::kTaper, 1.5, 0.5};
    taper.tip_angle = 0.3;
    return {{1, ToolShape::kFlat, 1.5, 0}, {2, ToolShape::kBull, 1.5, 0.5}, taper};
}

std::vector<Vec3d> tips_of(const std::vector<PlannedOperation>& planned)
{
    std::vector<Vec3d> out;
    for (const PlannedOperation& operation : planned) {
        Vec3d at = end_of(operation.path.moves.front());
        for (const ToolMove& move : operation.path.moves) {
            for (const Vec3d& to : points_of(move, at, 1e-4)) {
                const int parts = 1 + static_cast<int>(norm(to - at) / 0.1);
                for (int k = 0; k <= parts && move.kind != MoveKind::kRapid; ++k) {
                    out.push_back(at + (to - at) * (static_cast<double>(k) / parts));
                }
                at = to;
            }
        }
    }
    return out;
}

// mm: the lowest cut straight over a place, less its height; below 0: the depth of a gouge.
double cut_over(const std::vector<Vec3d>& tips, const Tool& tool, Vec3d place)
{
    double least = 1e9;
    for (const Vec3d& tip : tips) {
        const double away = std::hypot(tip.x - place.x, tip.y - place.y);
        if (away <= tool.radius) {
            least = std::min(least, tip.z + profile_height(tool, away));
        }
    }
    return least - place.z;
}

struct Left {
    double most{-1e9};  // mm, square to the ground
    double least{1e9};  // mm, straight up
};

// Over the top, the side, and the square beyond what the foot keeps a tool off.
Left left_on_hill(const std::vector<Vec3d>& tips, const Tool& tool)
{
    Left out;
    const auto look = [&](Vec3d place, double cosine) {
        const double over = cut_over(tips, tool, place);
        out.most = std::max(out.most, over * cosine);
        out.least = std::min(out.least, over);
    };
    for (int k = 0; k < 30; ++k) {
        const double turn = 2 * kPi * (k + 0.37) / 30;
        for (int j = 0; j < 8; ++j) {
            look({0.24 * j * std::cos(turn), 0.24 * j * std::sin(turn), 0}, 1);
            look(on_hill(turn, (kDeep - 0.8) * (j + 0.4) / 8), 0.5);
        }
        look({5.8 * std::cos(turn), 5.8 * std::sin(turn), -kDeep}, 1);
    }
    return out;
}

}  // namespace

TEST_GROUP(EveryEndFinish)
{
    Job job = job_for({}, kParallelPlanes);
    Operation& operation = job.operations.front();

    std::vector<Vec3d> planned(const Strategy& strategy, const Tool& tool)
    {
        operation = job_for({}, strategy).operations.front();
        operation.part.mesh = small_hill();
        operation.tool = tool;
        operation.tolerance.scallop = kScallopLeft;
        operation.tolerance.floor = operation.tolerance.plan = kBand;
        job.stock_top = 0.5;
        const std::vector<PlannedOperation> out = strategy.plan(job, operation);
        for (const PlannedOperation& some : out) {
            DOUBLES_EQUAL(0, some.stats.gouge_bound_mm, 0);
            DOUBLES_EQUAL(kScallopLeft, some.stats.scallop_bound_mm, 1e-12);
        }
        return tips_of(out);
    }
};

TEST(EveryEndFinish, LeavesNoMoreThanTheScallopAndCutsNothing)
{
    for (const Strategy* strategy :
         {&kParallelPlanes, &kSteepShallow, &cusp::adaptive_isocurve::kAdaptiveIsocurve}) {
        for (const Tool& tool : small_ends()) {
            const Left left = left_on_hill(planned(*strategy, tool), tool);
            CHECK(left.least >= -1e-6);
            CHECK(left.most <= kScallopLeft + kBetweenTips);
        }
    }
}

TEST(EveryEndFinish, LevelsLeaveNoMoreOnTheSide)
{
    for (const Tool& tool : small_ends()) {
        const std::vector<Vec3d> tips = planned(kWaterline, tool);
        double most = -1e9;
        for (int k = 0; k < 30; ++k) {
            for (int j = 0; j < 8; ++j) {
                const Vec3d place =
                    on_hill(2 * kPi * (k + 0.37) / 30, (kDeep - 0.8) * (j + 0.4) / 8);
                const double over = cut_over(tips, tool, place);
                CHECK(over >= -1e-6);
                most = std::max(most, 0.5 * over);
            }
        }
        CHECK(most <= kScallopLeft + kBetweenTips);
    }
}

// Facets stand for the surface; how far they are off it comes off the tolerance.
TEST(EveryEndFinish, CutsNoSurface)
{
    std::mt19937 random{5};
    const std::vector<nurbs::Surface> surfaces{bumps(random, 6)};
    for (const Tool& tool : {small_ends().front(), small_ends().back()}) {
        operation = job_for(surfaces, kParallelPlanes).operations.front();
        operation.tool = tool;
        operation.tolerance.scallop = 3 * kScallopLeft;
        operation.tolerance.floor = operation.tolerance.plan = kWideBand;
        const std::vector<Vec3d> tips = tips_of(plan_parallel_planes(job, operation));
        double least = 1e9;
        for (int i = 0; i <= 30; ++i) {
            for (int j = 0; j <= 30; ++j) {
                const nurbs::Surface& s = surfaces.front();
                least = std::min(
                    least, cut_over(tips, tool,
                                    point_at(s, s.u_begin() + (s.u_end() - s.u_begin()) * i / 30,
                                             s.v_begin() + (s.v_end() - s.v_begin()) * j / 30)));
            }
        }
        CHECK(least >= 0);
        CHECK(least < kWideBand);
    }
}
