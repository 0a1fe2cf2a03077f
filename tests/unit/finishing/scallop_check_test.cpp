// Cells of surfaces that are not yet cut.
#include "host_tools/finishing/scallop_check.hpp"

#include <cmath>

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

}  // namespace

TEST_GROUP(ScallopCheck){};

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
