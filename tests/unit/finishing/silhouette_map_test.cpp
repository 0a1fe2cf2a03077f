// Points below the side of a horizontal half pipe, very near to its silhouette.
#include "host_tools/cam/finishing/silhouette_map.hpp"

#include <cmath>
#include <utility>
#include <vector>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::part_model;

namespace {

constexpr double kBarRadius = 10;
constexpr double kPitch = 0.3;

// A half pipe along x, open to the left: from its top over the side to its bottom.
Surface pipe()
{
    const double weight = std::sqrt(0.5);
    Surface s;
    s.degree_u = 1;
    s.degree_v = 2;
    s.knots_u = {0, 0, 1, 1};
    s.knots_v = {0, 0, 0, 1, 1, 2, 2, 2};
    s.size_u = 2;
    s.size_v = 5;
    for (const double x : {0.0, 20.0}) {
        for (const auto& [y, z] : {std::pair{0.0, kBarRadius},
                                   {kBarRadius, kBarRadius},
                                   {kBarRadius, 0.0},
                                   {kBarRadius, -kBarRadius},
                                   {0.0, -kBarRadius}}) {
            s.points.push_back({x, y, z});
        }
        s.weights.insert(s.weights.end(), {1, weight, 1, weight, 1});
    }
    return s;
}

Vec3d on_pipe(double degrees)
{
    const double angle = degrees * std::acos(-1.0) / 180;
    return {7, kBarRadius * std::cos(angle), kBarRadius * std::sin(angle)};
}

}  // namespace

TEST_GROUP(SilhouetteMap){};

TEST(SilhouetteMap, FindsWhatLiesOverPlacesJustUnderAnEquator)
{
    const std::vector<Surface> surfaces{pipe()};
    const PartModel model{surfaces};
    const SilhouetteMap tops{surfaces, model, kPitch};
    for (const double degrees : {-1.0, -2.0, -5.0, -30.0, -80.0}) {
        CHECK(tops.finds_over(on_pipe(degrees), 1e-3));
        CHECK_FALSE(tops.finds_over(on_pipe(-degrees), 1e-3));
    }
    // Twice the sine of a degree, 0.349, over it.
    CHECK(tops.finds_over(on_pipe(-1), 0.34));
    CHECK_FALSE(tops.finds_over(on_pipe(-1), 0.36));
}

TEST(SilhouetteMap, FindsNothingWhereTheSurfaceIsTrimmedAway)
{
    Surface s = pipe();
    // The domain's lower half in v, the side from its top to its equator, is cut off.
    Curve rim;
    rim.degree = 1;
    rim.knots = {0, 0, 1, 2, 3, 4, 4};
    rim.points = {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    rim.weights.assign(5, 1.0);
    s.trims = {{rim}};
    const std::vector<Surface> surfaces{s};
    const PartModel model{surfaces};
    const SilhouetteMap tops{surfaces, model, kPitch};
    CHECK_FALSE(tops.finds_over(on_pipe(-5), 1e-3));
}
