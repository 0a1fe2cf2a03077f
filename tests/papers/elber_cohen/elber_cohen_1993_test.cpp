// Reproduces figure 2 and table 1 of Elber and Cohen 1993.
#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/adaptive_isocurve/isocurve_extraction.hpp"
#include "tests/support/example_parts.hpp"
#include "tests/support/tube.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::nurbs;
using namespace cusp::test;

namespace {

double length_on(const Surface& surface, const std::vector<DomainCurve>& curves)
{
    constexpr int kParts = 60;
    double sum = 0;
    for (const DomainCurve& curve : curves) {
        const Curve iso = isocurve_at_v(surface, curve.v.front());
        Vec3d last = point_at(iso, curve.u.front());
        for (int k = 1; k <= kParts; ++k) {
            const double t = static_cast<double>(k) / kParts;
            const Vec3d next = point_at(iso, curve.u.front() * (1 - t) + curve.u.back() * t);
            sum += norm(next - last);
            last = next;
        }
    }
    return sum;
}

}  // namespace

TEST_GROUP(ElberCohen1993){};

TEST(ElberCohen1993, TheSurfaceOfFigure2Has61Curves)
{
    const Surface hourglass = example_part("elber-cohen-hourglass.json");
    LONGS_EQUAL(61, adaptive_isocurves(hourglass, 0, 2).size());
    LONGS_EQUAL(61, adaptive_isocurves(hourglass, 0, 1.9).size());
    LONGS_EQUAL(31, adaptive_isocurves(hourglass, 0, 4).size());
    LONGS_EQUAL(121, adaptive_isocurves(hourglass, 0, 1).size());
    LONGS_EQUAL(241, adaptive_isocurves(hourglass, 0, 0.5).size());
}

TEST(ElberCohen1993, AdaptiveIsocurvesAreShorterThanCompleteOnes)
{
    const Surface hourglass = example_part("elber-cohen-hourglass.json");
    DOUBLES_EQUAL(2012, length_on(hourglass, adaptive_isocurves(hourglass, 0, 2)), 1);
    // 33 curves, as halving of the whole makes them
    DOUBLES_EQUAL(3497, length_on(hourglass, complete_isocurves(hourglass, 0, 1.9)), 1);
}

TEST(ElberCohen1993, NeighboursAreWithinDelta)
{
    const Surface knight = example_part("elber-cohen-knight.json");
    const auto curves = adaptive_isocurves(knight, 0, 3);
    for (int k = 0; k <= 50; ++k) {
        const double u = 0.02 * k;
        double last_v = -1;
        Vec3d last;
        for (const DomainCurve& curve : curves) {
            if (curve.u.front() > u || u > curve.u.back() || curve.v.front() == last_v) {
                continue;
            }
            const Vec3d here = point_at(knight, u, curve.v.front());
            if (last_v >= 0) {
                CHECK(norm(here - last) <= 3 + 1e-9);
            }
            last = here;
            last_v = curve.v.front();
        }
    }
}

TEST(ElberCohen1993, AClosedSurfaceIsCoveredThoughItsBoundariesCoincide)
{
    const auto curves = adaptive_isocurves(tube(10, 30, true), 0, 5);
    // Once round is 62.8 mm: at least 13 curves, at most twice as dense and both boundaries.
    CHECK(curves.size() >= 13);
    CHECK(curves.size() <= 34);
}
