// The bound of neighbours against dense samples, on parts and on curves that cross.
#include "host_tools/cam/adaptive_isocurve/isocurve_spacing_bound.hpp"

#include <algorithm>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/adaptive_isocurve/equal_scallop_passes.hpp"
#include "host_tools/cam/adaptive_isocurve/isocurve_extraction.hpp"
#include "tests/support/example_parts.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;

namespace {

constexpr int kSpacingLooks = 5000;

double widest_seen(const Surface& s, const std::vector<DomainCurve>& curves)
{
    double widest = 0;
    for (int k = 0; k <= kSpacingLooks; ++k) {
        const double u = s.u_begin() + (s.u_end() - s.u_begin()) * k / kSpacingLooks;
        const std::vector<CurvePlace> across = places_at(curves, u);
        for (std::size_t j = 1; j < across.size(); ++j) {
            const double low = std::clamp(across[j - 1].v, s.v_begin(), s.v_end());
            const double high = std::clamp(across[j].v, s.v_begin(), s.v_end());
            widest = std::max(widest, norm(point_at(s, u, high) - point_at(s, u, low)));
        }
    }
    return widest;
}

void check_bound(const char* name, const std::vector<DomainCurve>& curves, double allowed)
{
    const Surface s = example_part(name);
    const PartModel model{{s}};
    const double seen = widest_seen(s, curves);
    const double bound = IsocurveSpacingBound{s, model, 0}.over(curves, allowed);
    CHECK(bound >= seen - 1e-9);
    CHECK(bound <= std::max(allowed, 1.02 * seen));
}

}  // namespace

TEST_GROUP(IsocurveSpacingBound){};

TEST(IsocurveSpacingBound, HoldsForIsocurvesThatBeginAndEnd)
{
    const Surface s = example_part("elber-cohen-hourglass.json");
    check_bound("elber-cohen-hourglass.json", adaptive_isocurves(s, 0, 2), 2);
}

TEST(IsocurveSpacingBound, HoldsForPassesThatFollowTheirNeighbours)
{
    for (const char* name : {"elber-cohen-hourglass.json", "elber-cohen-knight.json"}) {
        const Surface s = example_part(name);
        const PartModel model{{s}};
        const auto at = [&](double u, double v) {
            return model.evaluate(0, u, v);
        };
        const auto steps = [](const SurfacePoint& p, double) {
            return norm(p.dv) / 2;
        };
        check_bound(name, equal_scallop_passes(s, 0, at, steps, {}).curves, 2);
    }
}

TEST(IsocurveSpacingBound, FindsNeighboursOfCurvesThatCross)
{
    const Surface s = example_part("elber-cohen-hourglass.json");
    const double u0 = s.u_begin();
    const double u1 = s.u_end();
    const auto v_at = [&](double share) {
        return s.v_begin() + (s.v_end() - s.v_begin()) * share;
    };
    const std::vector<DomainCurve> curves{
        isocurve(0, v_at(0.2), u0, u1),
        {0, {u0, u1}, {v_at(0.4), v_at(0.7)}},
        {0, {u0, u1}, {v_at(0.7), v_at(0.4)}},
        isocurve(0, v_at(0.9), u0, u1),
    };
    check_bound("elber-cohen-hourglass.json", curves, 0.1);
}

TEST(IsocurveSpacingBound, CountsTheWayAlongTheSidesOfCurvesThatComeFromOutside)
{
    const Surface s = example_part("elber-cohen-hourglass.json");
    const double u0 = s.u_begin();
    const double u1 = s.u_end();
    const double width = s.v_end() - s.v_begin();
    const std::vector<DomainCurve> curves{
        {0, {u0, u1}, {s.v_begin() - 0.2 * width, s.v_begin() + 0.3 * width}},
        isocurve(0, s.v_begin() + 0.5 * width, u0, u1),
    };
    check_bound("elber-cohen-hourglass.json", curves, 0.1);
}
