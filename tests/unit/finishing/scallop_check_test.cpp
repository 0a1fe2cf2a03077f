// Cells of surfaces that are not yet cut.
#include "host_tools/cam/finishing/scallop_check.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/parallel/parallel.hpp"
#include "tests/generators/faces_of_mesh.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::toolpath;

namespace {

constexpr double kSide = 12;  // mm

Surface plate()
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.size_u = s.size_v = 2;
    s.points = {{0, 0, 0}, {kSide, 0, 0}, {0, kSide, 0}, {kSide, kSide, 0}};
    s.weights.assign(4, 1.0);
    return s;
}

// A groove along y between two walls whose normals have the z given, with a flat bottom.
std::vector<Surface> groove(double normal_z, double high, double bottom)
{
    const double out = 0.5 * bottom;
    const double wide = out + high * normal_z / std::sqrt(1 - normal_z * normal_z);
    const double side = std::sqrt(1 - normal_z * normal_z);
    std::vector<Surface> faces{
        test::plane_face({{wide, 0, high}, {wide, kSide, high}, {out, kSide, 0}, {out, 0, 0}},
                         {-side, 0, normal_z}),
        test::plane_face({{-out, 0, 0}, {-out, kSide, 0}, {-wide, kSide, high}, {-wide, 0, high}},
                         {side, 0, normal_z})};
    if (bottom > 0) {
        // The domain, in mm, is turned, so that no side of a cell follows the strip.
        const Vec3d u{0.6, 0.8, 0};
        const Vec3d v{-0.8, 0.6, 0};
        const double far = 2 * kSide;
        Surface strip = test::plane_face(
            {u * -far - v * far, u * far - v * far, u * far + v * far, v * far - u * far},
            {0, 0, 1});
        const Vec3d origin = u * -far - v * far;
        std::vector<Vec2d> corners;
        for (const Vec3d& p :
             {Vec3d{-out, 0, 0}, Vec3d{out, 0, 0}, Vec3d{out, kSide, 0}, Vec3d{-out, kSide, 0}}) {
            corners.push_back({dot(p - origin, u), dot(p - origin, v)});
        }
        strip.trims = {test::loop_of(corners)};
        faces.push_back(strip);
    }
    return faces;
}

// The lowest tip of the passes that are missing over a part of the last face, beside the middle of the
// groove, after one along it at a height.
double lowest_missing(
    const std::vector<Surface>& faces, double tip_z, double scallop, Vec2d low, Vec2d high)
{
    const Tool ball{1, ToolShape::kBall, 1.0, 1.0};
    const PartModel model{faces};
    const GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(1e-3, false)};
    ScallopCheck check{faces, path_fitter, scallop, 0, 50000};
    check.add({{0, 0, tip_z}, {0, kSide, tip_z}});
    check.check(static_cast<int>(faces.size()) - 1, low, high);
    double lowest = tip_z;
    check.add_missing_passes(
        [&](const Points& pass) {
            for (const Vec3d& tip : pass) {
                // Beside the ends of the groove the ball falls off the part.
                if (std::abs(tip.y - 0.5 * kSide) < 0.25 * kSide) {
                    lowest = std::min(lowest, tip.z);
                }
            }
            check.add(pass);
        },
        [](double) {});
    return lowest;
}

// A plate, and a wall over its border y = 0.
std::vector<Surface> plate_with_wall()
{
    constexpr double kHigh = 4;
    return {plate(), test::plane_face({{0, 0, 0}, {kSide, 0, 0}, {kSide, 0, kHigh}, {0, 0, kHigh}},
                                      {0, -1, 0})};
}

struct WallResult {
    double left_before;  // mm, beside the wall, of the plate's passes
    double left_after;
    std::size_t uncovered;
    std::vector<Points> passes;
};

// Passes over the plate keep off its wall; then those along the wall that are missing. The plate itself
// is not looked at.
WallResult cut_beside_wall(int threads)
{
    const Tool ball{1, ToolShape::kBall, 2, 2};
    const std::vector<Surface> faces = plate_with_wall();
    const PartModel model{faces};
    const GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(0.01, true)};
    ScallopCheck check{faces, path_fitter, 0.05, 0};
    for (double y = ball.radius + 0.3; y <= kSide; y += 0.8) {
        check.add({{0, y, 0.006}, {kSide, y, 0.006}});
    }
    parallel::set_threads(threads);
    WallResult out{check.left_beside_walls(), 0, 0, {}};
    check.add_missing_passes(
        [&](const Points& pass) {
            out.passes.push_back(pass);
            check.add(pass);
        },
        [](double) {});
    out.left_after = check.left_beside_walls();
    out.uncovered = check.uncovered();
    return out;
}

}  // namespace

TEST_GROUP(ScallopCheck){};

// Beside a wall at the border nothing but passes along it removes the stock.
TEST(ScallopCheck, CutsBesideAStandingWall)
{
    const WallResult result = cut_beside_wall(2);
    CHECK(result.left_before > 0.2);
    CHECK(!result.passes.empty());
    DOUBLES_EQUAL(0, result.left_after, 0);
    LONGS_EQUAL(0, result.uncovered);
}

TEST(ScallopCheck, CutsTheSameBesideAWallWithAnyThreads)
{
    const WallResult one = cut_beside_wall(1);
    const WallResult three = cut_beside_wall(3);
    parallel::set_threads(2);
    LONGS_EQUAL(one.passes.size(), three.passes.size());
    for (std::size_t k = 0; k < one.passes.size(); ++k) {
        LONGS_EQUAL(one.passes[k].size(), three.passes[k].size());
        for (std::size_t i = 0; i < one.passes[k].size(); ++i) {
            CHECK(norm(one.passes[k][i] - three.passes[k][i]) == 0);
        }
    }
}

// In the smallest cells an uncovered plate would have five million of them.
TEST(ScallopCheck, ChecksAnUncutPlateInLargeCells)
{
    constexpr double kScallop = 0.02;
    const Tool ball{1, ToolShape::kBall, 1.5, 1.5};
    const std::vector<Surface> surfaces{plate()};
    const PartModel model{surfaces};
    const GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(0.005, true)};
    ScallopCheck coverage{surfaces, path_fitter, kScallop, 0, 50000};
    coverage.check(0);
    CHECK_FALSE(coverage.overflowed());
    double length = 0;
    coverage.add_missing_passes(
        [&](const Points& pass) {
            length += length_of(pass);
            coverage.add(pass);
        },
        [](double) {});
    LONGS_EQUAL(0, coverage.uncovered());
    CHECK_FALSE(coverage.overflowed());
    const double step = std::sqrt(8 * ball.radius * kScallop);
    CHECK(length < 2.3 * kSide * kSide / step);
}

// The ball rests on both walls of a groove too narrow for it. A pass 0.5 mm higher leaves more than
// the scallop over the bottom, a strip between trims that holds no corner of a cell.
TEST(ScallopCheck, CutsDownToASliverBetweenTrims)
{
    constexpr double kNormalZ = 0.1;
    constexpr double kBottom = 0.03;
    // The tip of a ball on both walls.
    const double rest = (1 - 0.5 * kBottom * std::sqrt(1 - kNormalZ * kNormalZ)) / kNormalZ - 1;
    const double lowest =
        lowest_missing(groove(kNormalZ, 12, kBottom), rest + 0.5, 0.06, {28.7, 27.5}, {28.9, 27.7});
    CHECK(lowest > rest - 0.1 && lowest < rest + 0.1);
}

// On walls steeper than 87 degrees that the ball can not touch, stock may be high but thick, too.
TEST(ScallopCheck, CutsDownBetweenSteepWalls)
{
    constexpr double kNormalZ = 0.04;
    constexpr double kRest = 1 / kNormalZ - 1;
    const double lowest =
        lowest_missing(groove(kNormalZ, 30, 0), kRest + 3, 0.05, {5.9, 0}, {6.1, 0.5});
    CHECK(lowest > kRest - 0.1 && lowest < kRest + 0.1);
}
