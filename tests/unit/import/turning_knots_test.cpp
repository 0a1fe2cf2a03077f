// Surfaces that turn far within a span get knots, and keep their shape and their trims.
#include "host_tools/job/import/turning_knots.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::nurbs;

namespace {

// A quarter of a tube of radius 10 along y: one rational quadratic span.
Surface quarter_tube()
{
    const double w = std::sqrt(0.5);
    Surface s{2, 1, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, 3, 2, {}, {}, {}};
    s.points = {{10, 0, 0}, {10, 5, 0}, {10, 0, 10}, {10, 5, 10}, {0, 0, 10}, {0, 5, 10}};
    s.weights = {1, 1, w, w, 1, 1};
    s.trims = {{Curve{1, {0, 0, 1, 1}, {{0, 0, 0}, {1, 0, 0}}, {1, 1}}}};
    return s;
}

}  // namespace

TEST_GROUP(TurningKnots){};

TEST(TurningKnots, CutAQuarterOfATubeAndKeepItsShape)
{
    const Surface tube = quarter_tube();
    const Surface cut = with_turning_knots(tube);
    LONGS_EQUAL(6, bezier_patches(cut).size());
    LONGS_EQUAL(1, cut.trims.size());
    for (int k = 0; k <= 40; ++k) {
        const Vec3d p = point_at(cut, k / 40.0, 0.3);
        DOUBLES_EQUAL(10, std::hypot(p.x, p.z), 1e-12);
        DOUBLES_EQUAL(0, norm(p - point_at(tube, k / 40.0, 0.3)), 1e-12);
    }
}

TEST(TurningKnots, LeaveAPlaneAlone)
{
    Surface plane{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, 2, 2, {}, {1, 1, 1, 1}, {}};
    plane.points = {{0, 0, 0}, {0, 9, 0}, {9, 0, 0}, {9, 9, 0}};
    LONGS_EQUAL(1, bezier_patches(with_turning_knots(plane)).size());
}
