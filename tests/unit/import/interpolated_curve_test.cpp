// Splines through points: against the equations of the cubic spline, cubics, and circles.
#include "host_tools/job/import/interpolated_curve.hpp"

#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/job/import/dxf_curves.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "tests/support/drawn_dxf.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::test;

namespace {

std::vector<Vec3d> random_points(unsigned seed, std::size_t count)
{
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> any{-50, 50};
    std::vector<Vec3d> points;
    for (std::size_t k = 0; k < count; ++k) {
        points.push_back({any(random), any(random), any(random)});
    }
    return points;
}

// Parameters: lengths of chords.
std::vector<double> parameters(const std::vector<Vec3d>& points)
{
    std::vector<double> at{0};
    for (std::size_t k = 1; k < points.size(); ++k) {
        at.push_back(at.back() + norm(points[k] - points[k - 1]));
    }
    return at;
}

// The second derivative by differences, on one side.
Vec3d bend(const nurbs::Curve& curve, double t, double step)
{
    const Vec3d a = point_at(curve, t);
    const Vec3d b = point_at(curve, t + step);
    const Vec3d c = point_at(curve, t + 2 * step);
    const Vec3d d = point_at(curve, t + 3 * step);
    return 1 / (step * step) * (2.0 * a - 5.0 * b + 4.0 * c - d);  // exact for cubics
}

std::string fit_spline(const std::vector<Vec2d>& points, int flags, const std::string& more = "")
{
    std::string out =
        fmt::format("0\nSPLINE\n8\no\n70\n{}\n71\n3\n72\n0\n73\n0\n74\n{}\n", flags, points.size());
    for (const Vec2d p : points) {
        out += fmt::format("11\n{}\n21\n{}\n31\n0.0\n", p.x, p.y);
    }
    return out + more;
}

std::vector<Vec2d> on_circle(Vec2d centre, double radius, int count)
{
    std::vector<Vec2d> points;
    for (int k = 0; k < count; ++k) {
        const double turn = 2 * kPi * k / count;
        points.push_back(centre + radius * Vec2d{std::cos(turn), std::sin(turn)});
    }
    return points;
}

}  // namespace

TEST_GROUP(InterpolatedCurve)
{
    TemporaryFolder folder;
    std::vector<std::string> notes;

    // The largest distance from a circle; the path has to be one loop.
    double off_circle(const std::string& entity, Vec2d centre, double radius)
    {
        notes.clear();
        const auto loops =
            read_loops(folder.with("d.dxf", dxf_drawing(entity)), 1, {0.02, {}}, notes);
        UNSIGNED_LONGS_EQUAL(1, loops.size());
        double most = 0;
        for (const Vec2d p : job::loop_polyline(loops[0].loop, 1e-6)) {
            most = std::max(most, std::abs(norm(p - centre) - radius));
        }
        return most;
    }
};

TEST(InterpolatedCurve, PassesThroughItsPointsWithContinuousCurvature)
{
    for (unsigned seed = 0; seed < 40; ++seed) {
        const bool closed = seed % 2 == 1;
        std::vector<Vec3d> points = random_points(seed, 3 + seed % 9);
        const nurbs::Curve curve = interpolated_curve(points, closed, {});
        if (closed) {
            points.push_back(points.front());
        }
        const std::vector<double> at = parameters(points);
        for (std::size_t k = 0; k < points.size(); ++k) {
            DOUBLES_EQUAL(0, norm(point_at(curve, at[k]) - points[k]), 1e-9);
        }
        constexpr double kStep = 1e-2;
        for (std::size_t k = 1; k + 1 < points.size(); ++k) {
            DOUBLES_EQUAL(0, norm(bend(curve, at[k], kStep) - bend(curve, at[k], -kStep)), 1e-6);
        }
        const Vec3d first = bend(curve, at.front(), kStep);
        const Vec3d last = bend(curve, at.back(), -kStep);
        if (closed) {
            DOUBLES_EQUAL(0, norm(first - last), 1e-6);
            DOUBLES_EQUAL(0,
                          norm(derivatives_at(curve, at.front()).first -
                               derivatives_at(curve, at.back()).first),
                          1e-9);
        } else {
            DOUBLES_EQUAL(0, norm(first) + norm(last), 1e-6);
        }
    }
}

TEST(InterpolatedCurve, HasTheTangentsThatAreGiven)
{
    const std::vector<Vec3d> points = random_points(7, 6);
    const nurbs::Curve curve = interpolated_curve(points, false, {Vec3d{0, 3, 0}, Vec3d{-2, 0, 0}});
    DOUBLES_EQUAL(0, norm(derivatives_at(curve, curve.domain_begin()).first - Vec3d{0, 1, 0}),
                  1e-9);
    DOUBLES_EQUAL(0, norm(derivatives_at(curve, curve.domain_end()).first - Vec3d{-1, 0, 0}), 1e-9);
}

TEST(InterpolatedCurve, OfTwoPointsIsALine)
{
    const nurbs::Curve curve = interpolated_curve({{1, 2, 0}, {1, 2, 0}, {5, 5, 0}}, false, {});
    for (int k = 0; k <= 10; ++k) {
        const Vec3d wanted = Vec3d{1, 2, 0} + 0.1 * k * Vec3d{4, 3, 0};
        DOUBLES_EQUAL(0, norm(point_at(curve, 0.5 * k) - wanted), 1e-12);
    }
}

TEST(InterpolatedCurve, ClosesAroundFitPointsOfACircle)
{
    const Vec2d centre{20, 20};
    std::vector<Vec2d> points = on_circle(centre, 15, 8);
    // closed, periodic, and by its last point; the error of the spline is 0.0013 of the radius
    constexpr double kEight = 0.02;
    CHECK(off_circle(fit_spline(points, 1), centre, 15) < kEight);
    STRCMP_CONTAINS("d.dxf: a SPLINE is given by fit points alone: cut as the cubic through them",
                    notes[0].c_str());
    CHECK(off_circle(fit_spline(points, 3), centre, 15) < kEight);
    points.push_back(points.front());
    CHECK(off_circle(fit_spline(points, 0), centre, 15) < kEight);
    CHECK(off_circle(fit_spline(points, 8 + 1), centre, 15) < kEight);
    // with tangents at both ends, of length 1 along chords, where the arc is 2.6 % longer
    CHECK(off_circle(fit_spline(points, 0, "12\n0\n22\n1\n32\n0\n13\n0\n23\n1\n33\n0\n"), centre,
                     15) < 0.05);
    CHECK(off_circle(fit_spline(on_circle(centre, 15, 32), 1), centre, 15) < 1e-4);
}

TEST(InterpolatedCurve, AnOpenSplineIsClosedByOtherCurves)
{
    const std::vector<Vec2d> arch{{0, 0}, {2, 3}, {5, 4}, {8, 3}, {10, 0}};
    const auto loops = read_loops(
        folder.with("d.dxf", dxf_drawing(fit_spline(arch, 0) + dxf_line({10, 0}, {0, 0}))), 1,
        {0.02, {}}, notes);
    UNSIGNED_LONGS_EQUAL(1, loops.size());
}

TEST(InterpolatedCurve, FitPointsThatMakeNoCurveAreRefused)
{
    const auto refused_spline = [&](const std::string& entity) {
        return refusal([&] { read_dxf_paths(folder.with("d.dxf", dxf_drawing(entity)), 1); });
    };
    STRCMP_CONTAINS("SPLINE whose fit points are one place",
                    refused_spline(fit_spline({{1, 1}, {1, 1}}, 0)).c_str());
    STRCMP_CONTAINS("SPLINE with 2 x, 1 y and 0 z of fit points",
                    refused_spline("0\nSPLINE\n71\n3\n11\n1\n21\n2\n11\n3\n").c_str());
}
