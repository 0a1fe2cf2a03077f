// Cells of surfaces that nothing has cut yet.
#include "host_tools/surface_passes/coverage.hpp"

#include <cmath>

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::host;

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

}  // namespace

TEST_GROUP(Coverage){};

// All of a bare plate in the smallest cells would be five million.
TEST(Coverage, CutsBareGroundWithoutHalvingItToTheLast)
{
    constexpr double kScallop = 0.02;
    const Tool ball{1, ToolShape::kBall, 1.5, 1.5};
    const std::vector<Surface> surfaces{plate()};
    const SurfaceModel model{surfaces};
    const CertifiedPasses certified{model, ball, make_pass_band(0.005, true)};
    Coverage coverage{surfaces, certified, kScallop, 0, 50000};
    coverage.look_over(0);
    CHECK_FALSE(coverage.overflowed());
    double length = 0;
    coverage.close_gaps(
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
