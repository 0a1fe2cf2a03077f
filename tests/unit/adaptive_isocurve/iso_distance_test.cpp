// The symbolic distance against distances of points.
#include "host_tools/cam/adaptive_isocurve/iso_distance.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::nurbs;

namespace {

Curve spline(std::vector<Vec3d> points, std::vector<double> weights)
{
    return {2, {0, 0, 0, 0.5, 1, 1, 1}, std::move(points), std::move(weights)};
}

double value_at(const ScalarSpline& spline, double u)
{
    for (const BernsteinPiece& piece : spline) {
        if (u <= piece.end) {
            const double t = (u - piece.begin) / (piece.end - piece.begin);
            std::vector<double> w = piece.coefficients;
            for (std::size_t n = w.size(); n > 1; --n) {
                for (std::size_t i = 0; i + 1 < n; ++i) {
                    w[i] = (1 - t) * w[i] + t * w[i + 1];
                }
            }
            return w[0];
        }
    }
    return 0;
}

}  // namespace

TEST_GROUP(IsoDistance)
{
    Curve a = spline({{0, 0, 0}, {10, 0, 1}, {20, 0, 5}, {30, 0, 0}}, {1, 1, 1, 1});
    Curve b = spline({{0, 9, 0}, {10, 1, 2}, {20, 1, -3}, {30, 8, 0}}, {1, 1, 1, 1});
};

TEST(IsoDistance, IsTheSquareOfTheDistanceOfPoints)
{
    const ScalarSpline excess = distance_excess(a, b, 2);
    for (int k = 0; k <= 20; ++k) {
        const double u = 0.05 * k;
        const Vec3d d = point_at(a, u) - point_at(b, u);
        DOUBLES_EQUAL(dot(d, d) - 4, value_at(excess, u), 1e-10);
    }
}

TEST(IsoDistance, HasTheSignOfTheDistanceForRationalCurves)
{
    a.weights = {1, 2, 0.5, 1};
    b.weights = {1, 0.7, 3, 1};
    const ScalarSpline excess = distance_excess(a, b, 3);
    for (int k = 0; k <= 40; ++k) {
        const double u = 0.025 * k;
        const bool apart = norm(point_at(a, u) - point_at(b, u)) > 3;
        CHECK_EQUAL(apart, value_at(excess, u) > 0);
    }
}

TEST(IsoDistance, ChangesSignWhereTheCurvesAreExactlyTheLimitApart)
{
    const std::vector<ParameterRange> ranges = sign_ranges(distance_excess(a, b, 4), 0, 1);
    CHECK(ranges.size() >= 2);
    DOUBLES_EQUAL(0, ranges.front().begin, 0);
    DOUBLES_EQUAL(1, ranges.back().end, 0);
    for (std::size_t k = 1; k < ranges.size(); ++k) {
        const double u = ranges[k].begin;
        DOUBLES_EQUAL(4, norm(point_at(a, u) - point_at(b, u)), 1e-9);
        CHECK(ranges[k].positive != ranges[k - 1].positive);
    }
}

TEST(IsoDistance, OfACurveFromItselfIsNowherePositive)
{
    const std::vector<ParameterRange> ranges = sign_ranges(distance_excess(a, a, 0.1), 0, 1);
    LONGS_EQUAL(1, ranges.size());
    CHECK_FALSE(ranges.front().positive);
}
