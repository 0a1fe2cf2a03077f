// Random curves and surfaces against de Boor's algorithm in long double, straight from the
// definition.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

using namespace cusp;
using namespace cusp::nurbs;

namespace {

using Real = long double;
struct Hom {
    Real x, y, z, w;
};

Hom mix(const Hom& a, const Hom& b, Real t)
{
    return {(1 - t) * a.x + t * b.x, (1 - t) * a.y + t * b.y, (1 - t) * a.z + t * b.z,
            (1 - t) * a.w + t * b.w};
}

Hom de_boor(int degree, const std::vector<double>& knots, const std::vector<Hom>& points, double u)
{
    const auto p = static_cast<std::size_t>(degree);
    std::size_t span = p;
    while (span + 1 < points.size() && knots[span + 1] <= u) {
        ++span;
    }
    while (!(knots[span] < knots[span + 1])) {
        --span;
    }
    std::vector<Hom> d(points.begin() + static_cast<long>(span - p),
                       points.begin() + static_cast<long>(span) + 1);
    for (std::size_t r = 1; r <= p; ++r) {
        for (std::size_t j = p; j >= r; --j) {
            const Real low = knots[j + span - p];
            const Real t = (u - low) / (knots[j + 1 + span - r] - low);
            d[j] = mix(d[j - 1], d[j], t);
        }
    }
    return d[p];
}

Vec3d projected(const Hom& h)
{
    return {static_cast<double>(h.x / h.w), static_cast<double>(h.y / h.w),
            static_cast<double>(h.z / h.w)};
}

Hom lifted(Vec3d p, double w) { return {Real{p.x} * w, Real{p.y} * w, Real{p.z} * w, w}; }

Vec3d oracle(const Curve& c, double u)
{
    std::vector<Hom> points;
    for (std::size_t i = 0; i < c.points.size(); ++i) {
        points.push_back(lifted(c.points[i], c.weights[i]));
    }
    return projected(de_boor(c.degree, c.knots, points, u));
}

Vec3d oracle(const Surface& s, double u, double v)
{
    std::vector<Hom> column;
    for (int i = 0; i < s.size_u; ++i) {
        std::vector<Hom> row;
        for (int j = 0; j < s.size_v; ++j) {
            const auto at = static_cast<std::size_t>(i * s.size_v + j);
            row.push_back(lifted(s.points[at], s.weights[at]));
        }
        column.push_back(de_boor(s.degree_v, s.knots_v, row, v));
    }
    return projected(de_boor(s.degree_u, s.knots_u, column, u));
}

class Random {
public:
    explicit Random(unsigned seed) : engine_{seed} {}
    double between(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(engine_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>{low, high}(engine_); }

    // Clamped or not, with repeated interior knots up to the degree.
    std::vector<double> knots(int degree, int count)
    {
        const bool clamped = whole(0, 2) > 0;
        std::vector<double> out;
        double u = between(-2, 2);
        int run = 0;
        for (int i = 0; i < count + degree + 1; ++i) {
            const bool end = i <= degree || i > count;
            const bool repeat = i > 0 && (end && clamped ? i != 0 && i != count + 1
                                                         : run < degree && whole(0, 3) == 0);
            if (i > 0 && !repeat && !(clamped && i <= degree)) {
                u += between(0.1, 1);
                run = 0;
            }
            ++run;
            out.push_back(u);
        }
        if (clamped) {
            const double last = out[static_cast<std::size_t>(count) - 1] + 0.5;
            std::fill(out.begin() + count, out.end(), last);
        }
        return out;
    }
    Vec3d point() { return {between(-100, 100), between(-100, 100), between(-100, 100)}; }
    double weight() { return whole(0, 1) == 0 ? 1.0 : between(0.2, 5); }

    Curve curve()
    {
        Curve c;
        do {
            c.degree = whole(1, 6);
            const int count = c.degree + whole(1, 8);
            c.knots = knots(c.degree, count);
            c.points.clear();
            c.weights.clear();
            for (int i = 0; i < count; ++i) {
                c.points.push_back(point());
                c.weights.push_back(weight());
            }
        } while (!(c.domain_begin() < c.domain_end()));
        return c;
    }
    Surface surface()
    {
        Surface s;
        do {
            s.degree_u = whole(1, 4);
            s.degree_v = whole(1, 4);
            s.size_u = s.degree_u + whole(1, 5);
            s.size_v = s.degree_v + whole(1, 5);
            s.knots_u = knots(s.degree_u, s.size_u);
            s.knots_v = knots(s.degree_v, s.size_v);
        } while (!(s.u_begin() < s.u_end() && s.v_begin() < s.v_end()));
        for (int i = 0; i < s.size_u * s.size_v; ++i) {
            s.points.push_back(point());
            s.weights.push_back(weight());
        }
        return s;
    }

private:
    std::mt19937 engine_;
};

void check_near(Vec3d expected, Vec3d actual, double allowed)
{
    DOUBLES_EQUAL(expected.x, actual.x, allowed);
    DOUBLES_EQUAL(expected.y, actual.y, allowed);
    DOUBLES_EQUAL(expected.z, actual.z, allowed);
}

constexpr double kTight = 1e-10;

}  // namespace

TEST_GROUP(RandomNurbs)
{
    unsigned seed{20261121};
    Random random{seed};
    void setup() override
    {
        UtestShell::getCurrent()->print(StringFromFormat("seed %u ", seed).asCharString(), __FILE__,
                                        __LINE__);
    }
};

TEST(RandomNurbs, CurvePointsEqualDeBoor)
{
    for (int n = 0; n < 5000; ++n) {
        const Curve c = random.curve();
        const double u = random.between(c.domain_begin(), c.domain_end());
        check_near(oracle(c, u), point_at(c, u), kTight);
        check_near(oracle(c, u), derivatives_at(c, u).point, kTight);
    }
}

TEST(RandomNurbs, CurvesEndWhereTheirDomainEnds)
{
    for (int n = 0; n < 1000; ++n) {
        const Curve c = random.curve();
        check_near(oracle(c, c.domain_end()), point_at(c, c.domain_end() + 1), kTight);
        check_near(oracle(c, c.domain_begin()), point_at(c, c.domain_begin() - 1), kTight);
    }
}

TEST(RandomNurbs, SurfacePointsEqualDeBoor)
{
    for (int n = 0; n < 5000; ++n) {
        const Surface s = random.surface();
        const double u = random.between(s.u_begin(), s.u_end());
        const double v = random.between(s.v_begin(), s.v_end());
        check_near(oracle(s, u, v), point_at(s, u, v), kTight);
        check_near(oracle(s, u, v), derivatives_at(s, u, v).point, kTight);
    }
}

TEST(RandomNurbs, CurveDerivativesAreLimitsOfDifferences)
{
    const double h = 1e-5;
    for (int n = 0; n < 1000; ++n) {
        const Curve c = bezier_pieces(random.curve()).front();
        const double u = (c.domain_begin() + c.domain_end()) / 2;
        const CurvePoint before = derivatives_at(c, u - h);
        const CurvePoint after = derivatives_at(c, u + h);
        const CurvePoint at = derivatives_at(c, u);
        const double scale = 1 + norm(at.first) + norm(at.second);
        check_near((after.point - before.point) / (2 * h), at.first, 1e-4 * scale);
        check_near((after.first - before.first) / (2 * h), at.second, 1e-4 * scale);
    }
}

TEST(RandomNurbs, SurfaceDerivativesAreLimitsOfDifferences)
{
    const double h = 1e-5;
    for (int n = 0; n < 500; ++n) {
        const Surface s = bezier_patches(random.surface()).front().surface;
        const double u = (s.u_begin() + s.u_end()) / 2;
        const double v = (s.v_begin() + s.v_end()) / 2;
        const SurfacePoint at = derivatives_at(s, u, v);
        const SurfacePoint u0 = derivatives_at(s, u - h, v);
        const SurfacePoint u1 = derivatives_at(s, u + h, v);
        const SurfacePoint v0 = derivatives_at(s, u, v - h);
        const SurfacePoint v1 = derivatives_at(s, u, v + h);
        const double scale =
            1 + norm(at.du) + norm(at.dv) + norm(at.duu) + norm(at.duv) + norm(at.dvv);
        check_near((u1.point - u0.point) / (2 * h), at.du, 1e-4 * scale);
        check_near((v1.point - v0.point) / (2 * h), at.dv, 1e-4 * scale);
        check_near((u1.du - u0.du) / (2 * h), at.duu, 1e-4 * scale);
        check_near((v1.du - v0.du) / (2 * h), at.duv, 1e-4 * scale);
        check_near((v1.dv - v0.dv) / (2 * h), at.dvv, 1e-4 * scale);
    }
}

TEST(RandomNurbs, BothPartsOfASplitCurveAreTheCurve)
{
    for (int n = 0; n < 2000; ++n) {
        const Curve c = random.curve();
        const double begin = c.domain_begin();
        const double end = c.domain_end();
        const double at = begin + (end - begin) * random.between(0.01, 0.99);
        const auto parts = split_at(c, at);
        for (int k = 0; k < 4; ++k) {
            const double u = random.between(begin, end);
            check_near(oracle(c, u), point_at(parts[u < at ? 0 : 1], u), kTight);
        }
        DOUBLES_EQUAL(at, parts[0].domain_end(), 0);
        DOUBLES_EQUAL(at, parts[1].domain_begin(), 0);
        check_near(parts[0].points.back(), parts[1].points.front(), kTight);
    }
}

TEST(RandomNurbs, ASplitAtAKnotSharesTheCurve)
{
    for (int n = 0; n < 2000; ++n) {
        const Curve c = random.curve();
        for (const double at : c.knots) {
            if (at > c.domain_begin() && at < c.domain_end()) {
                const auto parts = split_at(c, at);
                const double u = random.between(c.domain_begin(), c.domain_end());
                check_near(oracle(c, u), point_at(parts[u < at ? 0 : 1], u), kTight);
            }
        }
    }
}

TEST(RandomNurbs, BezierPiecesCoverTheCurve)
{
    for (int n = 0; n < 2000; ++n) {
        const Curve c = random.curve();
        const auto pieces = bezier_pieces(c);
        double reached = c.domain_begin();
        for (const Curve& piece : pieces) {
            DOUBLES_EQUAL(reached, piece.domain_begin(), 0);
            reached = piece.domain_end();
            LONGS_EQUAL(c.degree + 1, piece.points.size());
            const double u = random.between(piece.domain_begin(), piece.domain_end());
            check_near(oracle(c, u), point_at(piece, u), kTight);
        }
        DOUBLES_EQUAL(c.domain_end(), reached, 0);
    }
}

TEST(RandomNurbs, BezierPatchesAreTheSurface)
{
    for (int n = 0; n < 500; ++n) {
        const Surface s = random.surface();
        for (const BezierPatch& patch : bezier_patches(s)) {
            const double u = random.between(patch.u_begin, patch.u_end);
            const double v = random.between(patch.v_begin, patch.v_end);
            check_near(oracle(s, u, v), point_at(patch.surface, u, v), kTight);
        }
    }
}

TEST(RandomNurbs, IsocurvesLieOnTheSurface)
{
    for (int n = 0; n < 2000; ++n) {
        const Surface s = random.surface();
        const double u = random.between(s.u_begin(), s.u_end());
        const double v = random.between(s.v_begin(), s.v_end());
        check_near(oracle(s, u, v), point_at(isocurve_at_u(s, u), v), kTight);
        check_near(oracle(s, u, v), point_at(isocurve_at_v(s, v), u), kTight);
    }
}

TEST(RandomNurbs, AReversedCurveRunsBackwards)
{
    for (int n = 0; n < 1000; ++n) {
        const Curve c = random.curve();
        const double share = random.between(0, 1);
        const Curve back = reversed(c);
        const double length = c.domain_end() - c.domain_begin();
        check_near(oracle(c, c.domain_begin() + share * length),
                   point_at(back, back.domain_end() - share * length), 1e-8);
    }
}

TEST(RandomNurbs, ClampedEndsLeaveTheShape)
{
    for (int n = 0; n < 1000; ++n) {
        const Curve c = random.curve();
        const Curve cut = clamped(c);
        const double u = random.between(c.domain_begin(), c.domain_end());
        check_near(oracle(c, u), point_at(cut, u), kTight);
        check_near(oracle(c, c.domain_begin()), cut.points.front(), kTight);
        check_near(oracle(c, c.domain_end()), cut.points.back(), kTight);
        LONGS_EQUAL(cut.points.size() + static_cast<std::size_t>(cut.degree) + 1, cut.knots.size());
        const Surface s = random.surface();
        const Surface trimmed = clamped(s);
        const double a = random.between(s.u_begin(), s.u_end());
        const double b = random.between(s.v_begin(), s.v_end());
        check_near(oracle(s, a, b), point_at(trimmed, a, b), kTight);
        check_near(oracle(s, s.u_begin(), s.v_begin()), trimmed.points.front(), kTight);
    }
}

TEST(RandomNurbs, AnExtendedSurfaceGoesOnAsItsEndsDo)
{
    constexpr double kExtended = 1e-8;  // beyond the domain rounding grows
    for (int n = 0; n < 1000; ++n) {
        const Surface s = clamped(random.surface());
        const double more_u = 0.1 * (s.u_end() - s.u_begin());
        const double more_v = 0.1 * (s.v_end() - s.v_begin());
        const Surface larger =
            extended(s, s.u_begin() - more_u, s.u_end(), s.v_begin() - more_v, s.v_end() + more_v);
        DOUBLES_EQUAL(s.u_begin() - more_u, larger.u_begin(), 0);
        DOUBLES_EQUAL(s.u_end(), larger.u_end(), 0);
        DOUBLES_EQUAL(s.v_end() + more_v, larger.v_end(), 0);
        const double a = random.between(larger.u_begin(), larger.u_end());
        const double b = random.between(larger.v_begin(), larger.v_end());
        check_near(oracle(s, a, b), point_at(larger, a, b), kExtended);
    }
}

TEST_GROUP(UpwardNormal){};

TEST(UpwardNormal, PointsUpWhicheverWayTheParametersRun)
{
    SurfacePoint s;
    s.du = {1, 0, 0};
    s.dv = {0, 2, 0};
    DOUBLES_EQUAL(1, upward_normal(s).z, 1e-15);
    std::swap(s.du, s.dv);
    DOUBLES_EQUAL(1, upward_normal(s).z, 1e-15);
}

TEST(UpwardNormal, PointsToTheLeftOfDuOnAWall)
{
    SurfacePoint s;
    s.du = {1, 0, 0};
    s.dv = {0, 0, 1};
    DOUBLES_EQUAL(1, upward_normal(s).y, 1e-15);
    s.dv = {0, 0, -1};
    DOUBLES_EQUAL(1, upward_normal(s).y, 1e-15);
}

TEST(UpwardNormal, IsThatOfPlacesBesideAPole)
{
    // Places where du is rounding error, or zero.
    for (const Vec3d du : {Vec3d{}, Vec3d{1e-16, 3e-17, 2e-16}}) {
        SurfacePoint s;
        s.du = du;
        s.dv = {0, 2, 0};
        s.duv = {1, 0, 0};
        DOUBLES_EQUAL(1, upward_normal(s).z, 1e-15);
        std::swap(s.du, s.dv);
        DOUBLES_EQUAL(1, upward_normal(s).z, 1e-15);
    }
}

TEST(UpwardNormal, IsZeroWhereTheDerivativesAreParallel)
{
    SurfacePoint s;
    s.du = {1, 1, 0};
    s.dv = {2, 2, 0};
    DOUBLES_EQUAL(0, norm(upward_normal(s)), 0);
}
