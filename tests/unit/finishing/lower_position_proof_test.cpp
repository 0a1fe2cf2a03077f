// True if a ball gets lower over points of rough and of smooth meshes, compared with a ball dropped
// on a fine grid around each.
#include "host_tools/cam/finishing/lower_position_proof.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::part_model;
using namespace cusp::toolpath;

namespace {

constexpr double kRadius = 3;
constexpr double kTolerance = 0.01;
constexpr double kBowlSide = 12;  // mm
constexpr double kFine = 0.06;

constexpr Vec2d kCorner{0.7, 0.4};  // of two walls

using Mesh = std::vector<std::array<Vec3d, 3>>;

// Triangles of size `pitch` over a bowl, each corner displaced at random.
Mesh rough_bowl(double pitch, double noise, std::mt19937& random)
{
    std::normal_distribution<double> off{0, noise};
    const int count = static_cast<int>(kBowlSide / pitch);
    std::vector<Vec3d> corners;
    for (int i = 0; i <= count; ++i) {
        for (int j = 0; j <= count; ++j) {
            const double x = i * pitch - kBowlSide / 2;
            const double y = j * pitch - kBowlSide / 2;
            corners.push_back({x, y, 0.04 * (x * x + y * y) + off(random)});
        }
    }
    Mesh mesh;
    const auto at = [&](int i, int j) {
        return corners[static_cast<std::size_t>(i * (count + 1) + j)];
    };
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            mesh.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

// A floor of large triangles, at a corner of a wall that leans and one that does not.
Mesh corner_of_walls(double lean)
{
    Mesh mesh;
    const auto add = [&](Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
        mesh.push_back({a, b, c});
        mesh.push_back({a, c, d});
    };
    add({-20, -20, 0}, {kCorner.x, -20, 0}, {kCorner.x, kCorner.y, 0}, {-20, kCorner.y, 0});
    add({kCorner.x, -20, 0}, {kCorner.x + lean, -20, 8}, {kCorner.x + lean, kCorner.y, 8},
        {kCorner.x, kCorner.y, 0});
    add({kCorner.x, kCorner.y, 0}, {kCorner.x + lean, kCorner.y, 8}, {-20, kCorner.y, 8},
        {-20, kCorner.y, 0});
    add({kCorner.x + lean, -20, 8}, {20, -20, 8}, {20, kCorner.y, 8},
        {kCorner.x + lean, kCorner.y, 8});
    add({-20, kCorner.y, 8}, {20, kCorner.y, 8}, {20, 20, 8}, {-20, 20, 8});
    return mesh;
}

struct Ground {
    explicit Ground(const Mesh& mesh) : model{mesh}
    {
        tool.radius = tool.corner_radius = kRadius;
        path_fitter.emplace(model, tool, make_tolerance_band(kTolerance, true));
    }

    struct Lowest {
        double height;
        Vec3d centre;
    };

    // The least height that a ball of a fine grid leaves at (x, y), and its centre. The grid is made finer
    // around the best ball: beside a wall its place counts.
    Lowest lowest(double x, double y) const
    {
        Lowest best{1e300, {}};
        search({x, y}, {x, y}, kRadius, kFine, best);
        for (double fine = kFine; fine > 1e-4; fine /= 8) {
            search({x, y}, {best.centre.x, best.centre.y}, fine, fine / 8, best);
        }
        return best;
    }

    void search(Vec2d place, Vec2d middle, double reach, double pitch, Lowest& best) const
    {
        for (double dx = -reach; dx <= reach; dx += pitch) {
            for (double dy = -reach; dy <= reach; dy += pitch) {
                const Vec2d at{middle.x + dx, middle.y + dy};
                const double under = kRadius * kRadius - (at.x - place.x) * (at.x - place.x) -
                                     (at.y - place.y) * (at.y - place.y);
                const auto rest = model.drop_ball(at.x, at.y, path_fitter->offset_tool().radius);
                if (under > 0 && rest && rest->centre.z - std::sqrt(under) < best.height) {
                    best = {rest->centre.z - std::sqrt(under), rest->centre};
                }
            }
        }
    }

    PartModel model;
    Tool tool;
    std::optional<GougeFreePathFitter> path_fitter;
};

// Number of points without a lower ball just below the lowest of the grid, by the proof.
int decided_places(const Mesh& mesh,
                   Vec2d low,
                   Vec2d high,
                   int places,
                   std::mt19937& random,
                   bool beside_walls = false)
{
    const Ground ground{mesh};
    LowerPositionProof lower{*ground.path_fitter, 0.375};
    std::uniform_real_distribution<double> across{low.x, high.x};
    std::uniform_real_distribution<double> along{low.y, high.y};
    int proved = 0;
    for (int k = 0; k < places; ++k) {
        const double x = across(random);
        const double y = along(random);
        const Ground::Lowest best = ground.lowest(x, y);
        for (const double over : {-0.03, -0.01, -1e-4, 1e-4, 0.003, 0.01, 0.03}) {
            const LowerPositionProof::Verdict answer =
                lower.verdict_over({x, y, best.height + over}, best.centre);
            // A ball of the grid is lower; one that is not of the grid is not much lower, but beside walls.
            CHECK_TRUE(over < 0 || answer != LowerPositionProof::Verdict::kNone);
            CHECK_TRUE(over > -0.03 || beside_walls || answer != LowerPositionProof::Verdict::kOne);
            proved += over == -0.03 && answer == LowerPositionProof::Verdict::kNone ? 1 : 0;
        }
    }
    return proved;
}

}  // namespace

TEST_GROUP(LowerPositionProof){};

TEST(LowerPositionProof, NoBallIsLowerWhereItSaysSoAndMostlyItDoes)
{
    const unsigned seed = 7;
    std::mt19937 random{seed};
    std::printf("seed %u\n", seed);
    constexpr int kPlaces = 12;
    // On smooth ground facets block directions everywhere.
    CHECK_TRUE(decided_places(rough_bowl(1.0, 0.1, random), {-2, -2}, {2, 2}, kPlaces, random) >
               kPlaces / 2);
    CHECK_TRUE(decided_places(rough_bowl(0.4, 0.1, random), {-2, -2}, {2, 2}, kPlaces, random) >
               kPlaces / 2);
    decided_places(rough_bowl(0.5, 0.0, random), {-2, -2}, {2, 2}, kPlaces, random);
}

TEST(LowerPositionProof, DecidesAtFeetOfWallsOfLargeFacets)
{
    const unsigned seed = 11;
    std::mt19937 random{seed};
    std::printf("seed %u\n", seed);
    constexpr int kPlaces = 40;
    for (const double lean : {0.0, 0.6, 3.0}) {
        const int decided =
            decided_places(corner_of_walls(lean), {kCorner.x - 1.2, kCorner.y - 1.2}, kCorner,
                           kPlaces, random, true);
        std::printf("lean %.1f: %d of %d\n", lean, decided, kPlaces);
        CHECK_TRUE(decided > 3 * kPlaces / 4);
    }
}
