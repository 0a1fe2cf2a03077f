// A ball dropped on trimmed planes that are slivers or nearly vertical, compared with brute force.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "tests/generators/draw.hpp"
#include "tests/generators/faces_of_mesh.hpp"
#include "tests/judges/ball_on_triangles.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace drop_cutter;
using namespace toolpath;

namespace {

constexpr double kDropAccuracy = 1e-4;  // mm
constexpr int kFaces = 2000;
constexpr int kDropsOnEach = 40;

Vec3d random_place(Draw& draw, double wide, double high)
{
    return {draw.uniform(-wide, wide), draw.uniform(-wide, wide), draw.uniform(-high, high)};
}

// A triangle of up to 4 mm; of three, one is a sliver of 1 um to 0.1 mm.
std::array<Vec3d, 3> random_triangle(Draw& draw)
{
    const Vec3d a = random_place(draw, 2.0, 1.0);
    Vec3d b = random_place(draw, 2.0, 1.0);
    Vec3d c = random_place(draw, 2.0, 1.0);
    if (draw.whole(0, 2) == 0) {
        c = b + random_place(draw, 0.3, 1.0) * std::pow(10.0, draw.uniform(-6.0, -1.0));
    }
    if (cross(b - a, c - a).z < 0) {
        std::swap(b, c);
    }
    // The face's u is along the first side.
    std::array<Vec3d, 3> corners{a, b, c};
    std::rotate(corners.begin(), corners.begin() + draw.whole(0, 2), corners.end());
    return corners;
}

}  // namespace

TEST_GROUP(SliverFaces){};

// Never lower than on the triangle, nor higher than a ball a little larger. On a nearly vertical face
// that is far more in z than all round.
TEST(SliverFaces, ABallRestsOnThemAsOnTriangles)
{
    constexpr double kLeastUp = 1e-6;  // z of a normal
    constexpr double kLarger = 10 * kDropAccuracy;
    constexpr double kRounding = 1e-9;  // mm
    int rests = 0;
    int wrong = 0;
    for (unsigned seed = 1; seed <= kFaces; ++seed) {
        Draw draw{std::mt19937{seed}};
        const Triangles face{random_triangle(draw)};
        const double radius = draw.uniform(0.5, 2.5);
        if (!(BallOnTriangles::normal(face.front()).z > kLeastUp)) {
            continue;
        }
        const DropCutter cutter{
            faces_of(face), {1, ToolShape::kBall, radius, radius}, kDropAccuracy};
        const BallOnTriangles brute_force{face};
        for (int k = 0; k < kDropsOnEach; ++k) {
            const double x = draw.uniform(-3.0, 3.0);
            const double y = draw.uniform(-3.0, 3.0);
            const double least = brute_force.drop(x, y, radius);
            const double most = brute_force.drop(x, y, radius + kLarger) + kLarger;
            const auto cl = cutter.drop({x, y});
            const double centre = cl ? cl->z + radius : -kNothing;
            rests += std::isfinite(least) ? 1 : 0;
            if (centre < least - kRounding || centre > most) {
                ++wrong;
                std::printf("seed %u at (%.4f %.4f), R %.4f: %.5f, should be %.5f to %.5f\n", seed,
                            x, y, radius, centre, least, most);
            }
        }
    }
    CHECK(rests > kFaces);
    LONGS_EQUAL(0, wrong);
}

}  // namespace cusp::test
