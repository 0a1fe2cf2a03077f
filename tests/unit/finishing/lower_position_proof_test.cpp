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
    // The least height that a ball of a fine grid leaves at (x, y), and its centre.
    Lowest lowest(double x, double y) const
    {
        Lowest best{1e300, {}};
        for (double dx = -kRadius; dx <= kRadius; dx += kFine) {
            for (double dy = -kRadius; dy <= kRadius; dy += kFine) {
                const double under = kRadius * kRadius - dx * dx - dy * dy;
                const auto rest =
                    model.drop_ball(x + dx, y + dy, path_fitter->offset_tool().radius);
                if (under > 0 && rest && rest->centre.z - std::sqrt(under) < best.height) {
                    best = {rest->centre.z - std::sqrt(under), rest->centre};
                }
            }
        }
        return best;
    }

    PartModel model;
    Tool tool;
    std::optional<GougeFreePathFitter> path_fitter;
};

// Number of points without a lower ball just below the lowest of the grid, by the proof.
int decided_places(double pitch, double noise, int places, std::mt19937& random)
{
    const Ground ground{rough_bowl(pitch, noise, random)};
    LowerPositionProof lower{*ground.path_fitter, 0.375};
    std::uniform_real_distribution<double> place{-2, 2};
    int proved = 0;
    for (int k = 0; k < places; ++k) {
        const double x = place(random);
        const double y = place(random);
        const Ground::Lowest best = ground.lowest(x, y);
        for (const double over : {-0.03, -0.01, -1e-4, 1e-4, 0.003, 0.01, 0.03}) {
            const LowerPositionProof::Verdict answer =
                lower.verdict_over({x, y, best.height + over}, best.centre);
            // A ball of the grid is lower; one that is not of the grid is not much lower.
            CHECK_TRUE(over < 0 || answer != LowerPositionProof::Verdict::kNone);
            CHECK_TRUE(over > -0.03 || answer != LowerPositionProof::Verdict::kOne);
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
    // On the rough mesh the ball touches few points; on smooth ground contacts block directions
    // everywhere.
    CHECK_TRUE(decided_places(1.0, 0.1, kPlaces, random) > kPlaces / 2);
    CHECK_TRUE(decided_places(0.4, 0.1, kPlaces, random) > kPlaces / 2);
    decided_places(0.5, 0.0, kPlaces, random);
}
