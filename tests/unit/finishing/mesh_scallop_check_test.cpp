// A wall of 89 degrees at the rim of a plate: rows over the plate leave it, passes along it do not.
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/box_mesh.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr double kScallop = 0.05;
constexpr double kLength = 12;  // mm, along y
constexpr double kHeight = 11.5;
constexpr double kSlope = 0.0174551;  // tangent of a degree

// A plate x from -6 to 0 at z = 0, and the wall down from its rim.
Triangles plate_and_wall(double slope)
{
    Triangles out;
    add_quad(out, {-6, 0, 0}, {0, 0, 0}, {0, kLength, 0}, {-6, kLength, 0});
    const double foot = kHeight * slope;
    add_quad(out, {0, 0, 0}, {foot, 0, -kHeight}, {foot, kLength, -kHeight}, {0, kLength, 0});
    return out;
}

// Passes along y over the plate, and what is missing then.
std::vector<Points> missing_passes(const Triangles& part, std::size_t& uncovered)
{
    const Tool ball{1, ToolShape::kBall, 3, 3};
    const PartModel model{part};
    GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(0.01, true)};
    MeshScallopCheck check{part, path_fitter, kScallop, 0};
    for (double x = -7; x <= 0.5; x += 0.8) {
        const double end = std::clamp(x, -6.0, 0.0);
        check.add(path_fitter.sample_dropped({end, -2, 0}, {end, kLength + 2, 0}));
    }
    std::vector<Points> passes;
    check.check();
    check.add_missing_passes([&](const Points& tips) {
        passes.push_back(tips);
        check.add(tips);
    });
    uncovered = check.left().uncovered;
    return passes;
}

}  // namespace

TEST_GROUP(MeshScallopCheck){};

TEST(MeshScallopCheck, AddsPassesAlongAWallOf89Degrees)
{
    std::size_t uncovered = 1;
    const std::vector<Points> passes = missing_passes(plate_and_wall(kSlope), uncovered);
    LONGS_EQUAL(0, uncovered);
    CHECK(!passes.empty());
    // Without them the stock over the foot is 0.2 mm thick, the lean of the wall.
    SweptVolume swept{3, 1};
    for (const Points& tips : passes) {
        swept.add(tips);
    }
    for (double y = 0.5; y < kLength; y += 0.5) {
        for (double z = -0.99 * kHeight; z < -0.3; z += 0.3) {
            const Vec3d over{-z * kSlope + kScallop, y, z + kScallop * kSlope};
            std::vector<std::uint32_t> near;
            swept.near_or_below(over + Vec3d{3 - kScallop, 0, 0}, near);
            CHECK(std::any_of(near.begin(), near.end(),
                              [&](std::uint32_t move) { return swept.removes(move, over, 0); }));
        }
    }
}

// Its foot carries a ball beside it. A pass there leaves the lean and the tolerance; if that is too
// much, one more higher up along both facets removes it.
TEST(MeshScallopCheck, AddsFewPassesWhereTheWallLeansLessThanTheScallop)
{
    std::size_t uncovered = 1;
    LONGS_EQUAL(1, missing_passes(plate_and_wall(0.5 * kScallop / kHeight), uncovered).size());
    LONGS_EQUAL(0, uncovered);
    LONGS_EQUAL(2, missing_passes(plate_and_wall(0.9 * kScallop / kHeight), uncovered).size());
    LONGS_EQUAL(0, uncovered);
}

// A ball beside it would go down without end.
TEST(MeshScallopCheck, AddsNoneAlongAVerticalWallWithNothingBelow)
{
    std::size_t uncovered = 1;
    CHECK(missing_passes(plate_and_wall(0), uncovered).empty());
    LONGS_EQUAL(0, uncovered);
}

// The ball rests on the ledge's edge, its axis beyond the part.
TEST(MeshScallopCheck, AddsAPassBesideAVerticalWallOverANarrowLedge)
{
    constexpr double kLedge = 0.4;
    Triangles part = plate_and_wall(0);
    add_quad(part, {0, 0, -kHeight}, {kLedge, 0, -kHeight}, {kLedge, kLength, -kHeight},
             {0, kLength, -kHeight});
    std::size_t uncovered = 1;
    const std::vector<Points> passes = missing_passes(part, uncovered);
    LONGS_EQUAL(0, uncovered);
    const double rests = -kHeight - 3 + std::sqrt(9 - (3 - kLedge) * (3 - kLedge));
    CHECK(std::any_of(passes.begin(), passes.end(), [&](const Points& tips) {
        return std::all_of(tips.begin(), tips.end(), [&](Vec3d tip) {
            return tip.x > 3 && tip.x < 3.01 && std::abs(tip.z - rests) < 0.02;
        });
    }));
}
