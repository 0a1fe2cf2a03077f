// Passes a step apart, on surfaces whose width varies.
#include "host_tools/cam/adaptive_isocurve/equal_scallop_passes.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

#include "tests/support/example_parts.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::nurbs;
using namespace cusp::test;

namespace {

struct Measured {
    double length{};
    double widest{};
};

Measured measure_passes(const Surface& s, const std::vector<DomainCurve>& curves)
{
    constexpr int kLooks = 700;
    Measured out;
    for (int k = 0; k < kLooks; ++k) {
        const double u = s.u_begin() + (s.u_end() - s.u_begin()) * k / kLooks;
        const double next = s.u_begin() + (s.u_end() - s.u_begin()) * (k + 1) / kLooks;
        std::vector<double> across;
        for (const DomainCurve& c : curves) {
            if (c.u.front() <= u && u <= c.u.back()) {
                across.push_back(c.v_at(u));
            }
            const double a = std::clamp(u, c.u.front(), c.u.back());
            const double b = std::clamp(next, c.u.front(), c.u.back());
            if (b > a) {
                out.length += norm(point_at(s, b, c.v_at(b)) - point_at(s, a, c.v_at(a)));
            }
        }
        std::sort(across.begin(), across.end());
        for (std::size_t j = 1; j < across.size(); ++j) {
            out.widest = std::max(out.widest,
                                  norm(point_at(s, u, across[j]) - point_at(s, u, across[j - 1])));
        }
    }
    return out;
}

std::vector<DomainCurve> passes_within(const Surface& s, double distance)
{
    return equal_scallop_passes(
               s, 0, [&](double u, double v) { return derivatives_at(s, u, v); },
               [&](const SurfacePoint& p, double) { return norm(p.dv) / distance; },
               [&](double u, CurvePlace low, CurvePlace high, double) {
                   return norm(point_at(s, u, high.v) - point_at(s, u, low.v)) / distance;
               })
        .curves;
}

}  // namespace

TEST_GROUP(EqualScallopPasses){};

TEST(EqualScallopPasses, KeepsNeighboursWithinTheStep)
{
    const Surface knight = example_part("elber-cohen-knight.json");
    CHECK(measure_passes(knight, passes_within(knight, 2)).widest <= 2);
}

TEST(EqualScallopPasses, IsAtMost1583mmOnTheHourglassUnderThePapersTest)
{
    const Surface hourglass = example_part("elber-cohen-hourglass.json");
    const Measured measured = measure_passes(hourglass, passes_within(hourglass, 2));
    CHECK(measured.widest <= 2);
    CHECK(measured.length <= 1583);
}
