// Approximated offsets: samples never exceed the bound, and isocurves are those of the
// approximation.
#include "host_tools/geometry/part_model/offset_surface.hpp"

#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/part_model/bernstein_patch.hpp"

using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::part_model;

namespace {

constexpr double kRadius = 3.0;

Surface bumps(unsigned seed, int degree, bool rational)
{
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> z{0, 5};
    std::uniform_real_distribution<double> w{0.6, 1.8};
    Surface s;
    s.degree_u = s.degree_v = degree;
    s.size_u = s.size_v = degree + 3;
    for (int i = 0; i <= 2 * degree + 3; ++i) {
        s.knots_u.push_back(i <= degree ? 0 : i >= degree + 3 ? 3 : i - degree);
    }
    s.knots_v = s.knots_u;
    for (int i = 0; i < s.size_u; ++i) {
        for (int j = 0; j < s.size_v; ++j) {
            s.points.push_back({6.0 * i, 5.0 * j, z(random)});
            s.weights.push_back(rational ? w(random) : 1.0);
        }
    }
    return s;
}

Vec3d exact_offset(const Surface& s, double u, double v)
{
    const SurfacePoint p = derivatives_at(s, u, v);
    return p.point + upward_normal(p) * kRadius;
}

double largest_sampled_error(const Surface& s, const OffsetSurface& offset)
{
    double most = 0;
    for (int j = 0; j <= 40; ++j) {
        const double v = s.v_begin() + (s.v_end() - s.v_begin()) * j / 40;
        const auto curve = offset.isocurve(v, s.u_begin(), s.u_end());
        CHECK(curve.has_value());
        for (int i = 0; i <= 200; ++i) {
            const double u = s.u_begin() + (s.u_end() - s.u_begin()) * i / 200;
            most = std::max(most, norm(point_at(*curve, u) - exact_offset(s, u, v)));
        }
    }
    return most;
}

}  // namespace

TEST_GROUP(BernsteinPatch){};

TEST(BernsteinPatch, ProductsAndQuartersHaveTheValuesTheyShould)
{
    const BernsteinPatch a{2, 1, {1, 2, -3, 4, 0.5, 6}};
    const BernsteinPatch b{1, 2, {2, -1, 3, 5, 0, 1}};
    const BernsteinPatch product = a * b;
    const auto parts = quarters(product);
    for (const double s : {0.0, 0.2, 0.7, 1.0}) {
        for (const double t : {0.0, 0.4, 1.0}) {
            DOUBLES_EQUAL(value_at(a, s, t) * value_at(b, s, t), value_at(product, s, t), 1e-12);
            DOUBLES_EQUAL(value_at(a, s, t) - value_at(b, s, t), value_at(a - b, s, t), 1e-12);
            DOUBLES_EQUAL(value_at(product, 0.5 + 0.5 * s, 0.5 * t), value_at(parts[2], s, t),
                          1e-12);
        }
    }
    CHECK(magnitude_bound(product) >= std::abs(value_at(product, 0.3, 0.6)));
}

TEST_GROUP(OffsetSurface){};

TEST(OffsetSurface, NoSampleIsFartherThanTheBoundAndTheBoundKeepsTheTolerance)
{
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const Surface s = bumps(seed, 2 + static_cast<int>(seed % 3), seed % 2 == 0);
        for (const double tolerance : {0.01, 0.001}) {
            const OffsetSurface offset{s, {kRadius, tolerance}};
            const double sampled = largest_sampled_error(s, offset);
            std::printf("seed %u tolerance %g: bound %.6f sampled %.6f, %d cells, %d points\n",
                        seed, tolerance, offset.error_bound(), sampled, offset.cells(),
                        offset.control_points());
            CHECK_EQUAL(0, offset.cells_without_bound());
            CHECK(offset.error_bound() <= tolerance);
            CHECK(sampled <= offset.error_bound() + 1e-12);
        }
    }
}

TEST(OffsetSurface, PartOfAnIsocurveIsTheWholeOneBetweenTheSameParameters)
{
    const Surface s = bumps(7, 3, false);
    const OffsetSurface offset{s, {kRadius, 0.005}};
    const auto whole = offset.isocurve(1.3, 0, 3);
    const auto part = offset.isocurve(1.3, 0.41, 2.77);
    CHECK(whole && part);
    DOUBLES_EQUAL(0.41, part->domain_begin(), 1e-15);
    DOUBLES_EQUAL(2.77, part->domain_end(), 1e-15);
    CHECK_EQUAL(3, part->degree);
    for (const double u : {0.41, 1.0, 1.7, 2.77}) {
        CHECK(norm(point_at(*whole, u) - point_at(*part, u)) < 1e-12);
    }
}

TEST(OffsetSurface, CreasesCutItInPiecesAndPolesHaveNoBound)
{
    // Two planes that meet at u = 1 in a crease.
    Surface roof;
    roof.degree_u = roof.degree_v = 1;
    roof.size_u = 3;
    roof.size_v = 2;
    roof.knots_u = {0, 0, 1, 2, 2};
    roof.knots_v = {0, 0, 1, 1};
    roof.points = {{0, 0, 0}, {0, 10, 0}, {5, 0, 4}, {5, 10, 4}, {10, 0, 0}, {10, 10, 0}};
    roof.weights.assign(6, 1.0);
    const OffsetSurface offset{roof, {kRadius, 0.001}};
    CHECK(!offset.isocurve(0.5, 0, 2));
    const auto side = offset.isocurve(0.5, 0, 1);
    CHECK(side.has_value());
    CHECK(norm(point_at(*side, 0.5) - exact_offset(roof, 0.5, 0.5)) < 1e-9);
    Surface fan = roof;
    fan.points[0] = fan.points[1];
    const OffsetSurface pole{fan, {kRadius, 0.001}};
    CHECK(pole.error_bound() <= 0.001);
}
