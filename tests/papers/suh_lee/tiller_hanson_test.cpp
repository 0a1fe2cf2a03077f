// Offsets of biarcs against Tiller and Hanson's offsets of the control polygon.
#include "tests/papers/suh_lee/tiller_hanson.hpp"

#include <cstdio>
#include <random>

#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace nurbs;
using namespace offset;

namespace {

constexpr double kDistance = 4.0;  // mm

// A wavy curve of 8 control points that bends nowhere to the left as tightly as the offset.
Curve random_curve(std::mt19937_64& random, int degree, bool rational)
{
    std::uniform_real_distribution<double> share{0.0, 1.0};
    Curve curve;
    curve.degree = degree;
    constexpr int kPoints = 8;
    for (int i = 0; i < kPoints; ++i) {
        curve.points.push_back({15.0 * i, 12.0 * (share(random) - 0.5), 0.0});
        curve.weights.push_back(rational ? 0.7 + 0.8 * share(random) : 1.0);
    }
    curve.knots.assign(static_cast<std::size_t>(degree + 1), 0.0);
    for (int i = 1; i < kPoints - degree; ++i) {
        curve.knots.push_back(static_cast<double>(i) / (kPoints - degree));
    }
    curve.knots.insert(curve.knots.end(), static_cast<std::size_t>(degree + 1), 1.0);
    return curve;
}

// Greatest difference of points from the distance that they should have from the edges.
double worst_of(const std::vector<Vec2d>& points, const EdgeTree& source)
{
    double worst = 0.0;
    for (const Vec2d p : points) {
        worst = std::max(worst, std::abs(source.nearest(p, 1e300) - kDistance));
    }
    return worst;
}

TEST_GROUP(TillerHanson){};

TEST(TillerHanson, InsertedKnotsDoNotMoveTheCurve)
{
    std::mt19937_64 random{11};
    const Curve curve = random_curve(random, 3, true);
    const Curve finer = with_knot(with_knot(curve, 0.37), 0.61);
    for (int i = 0; i <= 100; ++i) {
        DOUBLES_EQUAL(0.0, norm(point_at(curve, 0.01 * i) - point_at(finer, 0.01 * i)), 1e-12);
    }
}

TEST(TillerHanson, OffsetsLieWhereThoseOfBiarcsDo)
{
    constexpr unsigned kSeed = 1984;
    std::mt19937_64 random{kSeed};
    for (const double tolerance : {0.1, 0.01, 0.001}) {
        double worst_curve = 0.0;
        double worst_biarcs = 0.0;
        std::size_t points = 0;
        std::size_t arcs = 0;
        for (int i = 0; i < 40; ++i) {
            const Curve source = random_curve(random, 2 + i % 4, i % 2 == 1);
            const EdgeTree exact{fit_edges(source, 1e-6)};
            const TillerHanson offset = tiller_hanson(source, kDistance, tolerance);
            const std::vector<Edge> edges = fit_edges(source, tolerance);
            std::vector<Vec2d> on_curve;
            // The ends of the offset are the ends of normals: all of it faces the source.
            for (int k = 0; k <= 400; ++k) {
                const Vec3d p = point_at(offset.curve, k / 400.0);
                on_curve.push_back({p.x, p.y});
            }
            std::vector<Vec2d> on_biarcs;
            for (const Edge& edge : edges) {
                for (int k = 0; k <= 8; ++k) {
                    on_biarcs.push_back(point_on(edge, k / 8.0) +
                                        left_normal(tangent_on(edge, k / 8.0)) * kDistance);
                }
            }
            worst_curve = std::max(worst_curve, worst_of(on_curve, exact));
            worst_biarcs = std::max(worst_biarcs, worst_of(on_biarcs, exact));
            points += offset.curve.points.size();
            arcs += edges.size();
            CHECK(worst_of(on_curve, EdgeTree{edges}) <= 2.0 * tolerance + 1e-5);
        }
        std::printf(
            "seed %u tolerance %g: Tiller-Hanson %zu points, error %.2g mm; biarcs %zu, "
            "error %.2g mm\n",
            kSeed, tolerance, points, worst_curve, arcs, worst_biarcs);
        CHECK(worst_curve <= 1.1 * tolerance + 1e-5);
        CHECK(worst_biarcs <= tolerance + 1e-5);
    }
}

}  // namespace
}  // namespace cusp::test
