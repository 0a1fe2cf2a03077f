// Scallops on twisted and sheared patches, compared with those of a ball stepped along both passes.
#include "host_tools/cam/adaptive_isocurve/isocurve_scallop.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_isocurve;
using namespace nurbs;
using namespace part_model;

namespace {

constexpr double kRadius = 5;
constexpr double kSize = 20;     // mm
constexpr int kSteps = 4000;     // of the ball along a pass
constexpr int kPlaces = 120;     // along a strip
constexpr int kAcross = 40;      // of it
constexpr double kSteep = 1e-4;  // mm: of the steps

// z = twist x y around the middle; the far side is shifted by `shear` mm.
Surface patch(double twist, double shear)
{
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
    s.size_u = s.size_v = 4;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const double x = kSize * (i / 3.0 - 0.5);
            const double y = kSize * (j / 3.0 - 0.5);
            s.points.push_back({x + shear * (j / 3.0 - 0.5), y, twist * x * y});
            s.weights.push_back(1);
        }
    }
    return s;
}

// The largest height left by the ball between two passes, along the normal.
double stepped(const Surface& s, const DomainCurve& low, const DomainCurve& high)
{
    std::vector<Vec3d> centres;
    for (const DomainCurve* pass : {&low, &high}) {
        for (int k = 0; k <= kSteps; ++k) {
            const double u = static_cast<double>(k) / kSteps;
            const SurfacePoint p = derivatives_at(s, u, pass->v_at(u));
            centres.push_back(p.point + upward_normal(p) * kRadius);
        }
    }
    double most = 0;
    for (int i = 0; i <= kPlaces; ++i) {
        const double u = static_cast<double>(i) / kPlaces;
        for (int j = 1; j < kAcross; ++j) {
            const double share = static_cast<double>(j) / kAcross;
            const double v = low.v_at(u) + share * (high.v_at(u) - low.v_at(u));
            const SurfacePoint p = derivatives_at(s, u, v);
            const Vec3d normal = upward_normal(p);
            double least = kInfinite;
            for (const Vec3d centre : centres) {
                const Vec3d arm = centre - p.point;
                const double along = dot(arm, normal);
                const double square = kRadius * kRadius - dot(arm, arm) + along * along;
                if (square >= 0) {
                    least = std::min(least, along - std::sqrt(square));
                }
            }
            most = std::max(most, least);
        }
    }
    return most;
}

void compare(double twist, double shear, const DomainCurve& low, const DomainCurve& high)
{
    const Surface s = patch(twist, shear);
    const PartModel model{{s}};
    IsocurveScallop ridges{model, 0, {kRadius, 0}};
    const double found = ridges.highest({low, high}, 0, 1, 200).scallop_height;
    const double due = stepped(s, low, high);
    CHECK(found >= 0.99 * due - kSteep);
    CHECK(found <= 1.05 * due);
}

}  // namespace

TEST_GROUP(IsocurveScallop){};

TEST(IsocurveScallop, OnATwistedPatch)
{
    // the direction of the centre differs from that of the isocurve
    for (const double twist : {0.02, 0.05, -0.05}) {
        compare(twist, 0, isocurve(0, 0.5, 0, 1), isocurve(0, 0.6, 0, 1));
        compare(twist, 0, isocurve(0, 0.05, 0, 1), isocurve(0, 0.13, 0, 1));
    }
}

TEST(IsocurveScallop, AtTheEndsOfPassesOnAShearedPatch)
{
    // points at the end of one pass are nearest to the other one beyond its end
    compare(0, 15, isocurve(0, 0.5, 0, 1), isocurve(0, 0.6, 0, 1));
    compare(0.03, -15, isocurve(0, 0.3, 0, 1), isocurve(0, 0.38, 0, 1));
}

TEST(IsocurveScallop, BesidePassesThatBend)
{
    DomainCurve low{0, {}, {}};
    DomainCurve high{0, {}, {}};
    for (int k = 0; k <= 20; ++k) {
        const double u = k / 20.0;
        low.u.push_back(u);
        high.u.push_back(u);
        low.v.push_back(0.5 + 0.04 * std::sin(12 * u));
        high.v.push_back(0.58 + 0.04 * std::sin(12 * u));
    }
    compare(0.02, 10, low, high);
}

TEST(IsocurveScallop, BesideAPassThatTurnsAwayAtItsEnd)
{
    // its tangents pass near places that it never comes near to
    DomainCurve low{0, {}, {}};
    DomainCurve high{0, {}, {}};
    for (int k = 0; k <= 40; ++k) {
        const double u = k / 40.0;
        low.u.push_back(u);
        high.u.push_back(u);
        low.v.push_back(0.5 - 0.06 * std::max(0.0, u - 0.9) / 0.1 * std::max(0.0, u - 0.9) / 0.1);
        high.v.push_back(0.57 - 0.02 * u * u);
    }
    compare(0, 18, low, high);
    compare(0.02, 18, low, high);
}

}  // namespace cusp::test
