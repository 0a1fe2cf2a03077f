// Ground of creases that a ball can't touch, judged between the places that the check looks at: the ball
// closes it on a fine grid, and its passes are cut there.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
#include "tests/support/box_mesh.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr double kGroundBall = 3;
constexpr double kClaimed = 0.02;
constexpr double kGroundSide = 10;    // mm, of the ground
constexpr double kGroundFacet = 1.6;  // mm
constexpr double kGroundRise = 0.9;   // mm: heights are up to this
constexpr double kGroundGrid = 0.05;  // mm
constexpr double kJudgedFrom = 4.2;   // what is judged, in x and in y
constexpr double kJudgedTo = 5.8;

Triangles creased_ground(unsigned seed)
{
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> height{0, kGroundRise};
    const int n = static_cast<int>(kGroundSide / kGroundFacet) + 1;
    std::vector<Vec3d> at;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            at.push_back({i * kGroundFacet, j * kGroundFacet, height(random)});
        }
    }
    Triangles out;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const std::size_t k = static_cast<std::size_t>(i * (n + 1) + j);
            const std::size_t beside = k + static_cast<std::size_t>(n) + 1;
            out.push_back({at[k], at[beside], at[beside + 1]});
            out.push_back({at[k], at[beside + 1], at[k + 1]});
        }
    }
    return out;
}

// Heights on a grid over what is judged and a radius beyond.
struct CentreGrid {
    static constexpr int kMargin = static_cast<int>(kGroundBall / kGroundGrid) + 1;
    static constexpr int kInner = static_cast<int>((kJudgedTo - kJudgedFrom) / kGroundGrid) + 1;
    static constexpr int kAll = kInner + 2 * kMargin;

    static double place(int k) { return kJudgedFrom + (k - kMargin) * kGroundGrid; }
    double& operator()(int i, int j) { return heights[static_cast<std::size_t>(i * kAll + j)]; }
    std::vector<double> heights = std::vector<double>(std::size_t{kAll} * kAll, kInfinite);
};

// The ball's bottom at (x, y) over a centre, or kInfinite.
double ball_bottom(Vec3d centre, double x, double y)
{
    const double square = kGroundBall * kGroundBall - (x - centre.x) * (x - centre.x) -
                          (y - centre.y) * (y - centre.y);
    return square < 0 ? kInfinite : centre.z - std::sqrt(square);
}

// mm, vertically: the most that passes leave above what a ball on the grid could reach.
double most_left_over(const PartModel& model, const std::vector<Points>& passes)
{
    CentreGrid centres;
    for (int i = 0; i < CentreGrid::kAll; ++i) {
        for (int j = 0; j < CentreGrid::kAll; ++j) {
            const auto rest =
                model.drop_ball(CentreGrid::place(i), CentreGrid::place(j), kGroundBall);
            centres(i, j) = rest ? rest->centre.z : kInfinite;
        }
    }
    double most = 0;
    for (int i = CentreGrid::kMargin; i < CentreGrid::kMargin + CentreGrid::kInner; ++i) {
        for (int j = CentreGrid::kMargin; j < CentreGrid::kMargin + CentreGrid::kInner; ++j) {
            const double x = CentreGrid::place(i);
            const double y = CentreGrid::place(j);
            double reachable = kInfinite;
            for (int u = i - CentreGrid::kMargin;
                 u <= i + CentreGrid::kMargin && u < CentreGrid::kAll; ++u) {
                for (int v = j - CentreGrid::kMargin;
                     v <= j + CentreGrid::kMargin && v < CentreGrid::kAll; ++v) {
                    reachable = std::min(
                        reachable,
                        ball_bottom({CentreGrid::place(u), CentreGrid::place(v), centres(u, v)}, x,
                                    y));
                }
            }
            double now = kInfinite;
            for (const Points& tips : passes) {
                for (std::size_t k = 1; k < tips.size(); ++k) {
                    const Vec3d way = tips[k] - tips[k - 1];
                    if (std::hypot(tips[k].x - x, tips[k].y - y) > kGroundBall + norm(way)) {
                        continue;
                    }
                    const int parts = 1 + static_cast<int>(norm(way) / (0.5 * kGroundGrid));
                    for (int part = 0; part <= parts; ++part) {
                        const Vec3d tip = tips[k - 1] + way * (static_cast<double>(part) / parts);
                        now = std::min(now, ball_bottom(tip + Vec3d{0, 0, kGroundBall}, x, y));
                    }
                }
            }
            most = std::max(most, now - reachable);
        }
    }
    return most;
}

}  // namespace

TEST_GROUP(CreasedGround){};

TEST(CreasedGround, KeepsNoMoreThanTheScallopBetweenThePlacesLookedAt)
{
    constexpr unsigned kSeed = 5;
    std::printf("seed %u\n", kSeed);
    const Tool ball{1, ToolShape::kBall, kGroundBall, kGroundBall};
    for (unsigned seed = kSeed; seed < kSeed + 4; ++seed) {
        const Triangles part = creased_ground(seed);
        const PartModel model{part};
        GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(0.01, true)};
        MeshScallopCheck check{part, path_fitter, kClaimed, 0};
        std::vector<Points> passes;
        const auto cut = [&](const Points& tips) {
            passes.push_back(tips);
            check.add(tips);
        };
        for (double x = 0; x <= kGroundSide; x += check.step()) {
            cut(path_fitter.sample_dropped({x, 0, 0}, {x, kGroundSide, 0}));
        }
        check.check();
        check.add_missing_passes(cut);
        LONGS_EQUAL(0, check.left().uncovered);
        const double left = most_left_over(model, passes);
        std::printf("ground %u: %.4f mm left\n", seed, left);
        CHECK(left <= kClaimed);
    }
}
