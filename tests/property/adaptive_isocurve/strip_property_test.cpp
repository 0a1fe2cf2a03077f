// Smooth surfaces at sixty scallops: cells prove what strips between passes leave open, and those
// are few; nowhere more than the scallop, and no longer passes for it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "firmware/base/math.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/cross_section.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_isocurve;
using namespace job;
using namespace nurbs;
using namespace toolpath;

namespace {

constexpr double kLeast = 0.005;  // mm
constexpr double kMost = 0.05;
constexpr double kRadius = 3;
constexpr double kTolerance = 0.3;  // of the scallop
constexpr double kForRidges = 0.7;  // the same

// Points of a grid over the unit square.
Surface sheet(int degree, int size, const std::function<Vec3d(double, double)>& at)
{
    Surface s;
    s.degree_u = s.degree_v = degree;
    s.size_u = s.size_v = size;
    const int spans = size - degree;
    for (int k = -degree; k <= size; ++k) {
        const int knot = std::min(spans, std::max(0, k));
        s.knots_u.push_back(static_cast<double>(knot) / spans);
    }
    s.knots_v = s.knots_u;
    const auto greville = [&](int i) {
        double sum = 0;
        for (int k = 1; k <= degree; ++k) {
            sum += s.knots_u[static_cast<std::size_t>(i + k)];
        }
        return sum / degree;
    };
    for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) {
            s.points.push_back(at(greville(i), greville(j)));
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

struct Named {
    const char* name;
    Surface surface;
    double longer;  // at most, than the least
};

std::vector<Named> sheets()
{
    const auto hills = [](double x, double y) {
        return 1.4 * std::sin(kPi * x / 8 + 0.4) * std::cos(kPi * y / 9.5);
    };
    return {
        {"hills",
         sheet(3, 14,
               [&](double u, double v) {
                   return Vec3d{14 * u, 14 * v, hills(14 * u, 14 * v)};
               }),
         1.25},
        {"sheared",
         sheet(3, 12,
               [&](double u, double v) {
                   const double x = 12 * u + 5 * v;
                   return Vec3d{x, 12 * v, hills(x, 12 * v)};
               }),
         1.45},
        {"fan",
         sheet(3, 10,
               [](double u, double v) {
                   const double wide = 3 + 13 * u * u;
                   return Vec3d{14 * u, wide * (v - 0.5), std::sin(3 * u + 2 * v)};
               }),
         1.4},
        {"saddle",
         sheet(3, 6,
               [](double u, double v) {
                   return Vec3d{12 * u, 12 * v,
                                7 * (u - 0.5) * (u - 0.5) - 7 * (v - 0.5) * (v - 0.5)};
               }),
         1},
        {"parabolas",
         sheet(2, 9,
               [&](double u, double v) {
                   return Vec3d{12 * u, 12 * v, hills(12 * u, 12 * v)};
               }),
         1.25},
    };
}

Job job_for(const Surface& floor, double scallop)
{
    Job job;
    job.file = "job.toml";
    job.tools = {{1, ToolShape::kBall, kRadius, kRadius}};
    job.feed = 1000;
    job.plunge_feed = 250;
    job.stock_top = 20;
    job.clearance = 5;
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.part.floor = {floor};
    operation.tool = job.tools.front();
    operation.tolerance.plan = operation.tolerance.floor = kTolerance * scallop;
    operation.tolerance.scallop = scallop;
    job.operations = {operation};
    return job;
}

double count(const OperationStats& stats, const std::string& name)
{
    for (const auto& [key, value] : stats.counts) {
        if (key == name) {
            return value;
        }
    }
    return 0;
}

// Lower bound of the length of passes along u: area over the widest steps everywhere.
double least_length(const Surface& s, double scallop)
{
    constexpr int kParts = 60;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {
        for (int j = 0; j < kParts; ++j) {
            const SurfacePoint p =
                derivatives_at(s, s.u_end() * (i + 0.5) / kParts, s.v_end() * (j + 0.5) / kParts);
            sum += norm(cross(p.du, p.dv)) /
                   stepover(kRadius, kForRidges * scallop, cross_section_at(p).curvature);
        }
    }
    return sum * s.u_end() * s.v_end() / (kParts * kParts);
}

}  // namespace

TEST_GROUP(StripProperty){};

TEST(StripProperty, CellsProveOnlyWhereStripsDoNot)
{
    const int scallops = property_cases(10);
    for (const Named& each : sheets()) {
        int some = 0;
        double most = 0;
        double longer = 0;
        for (int k = 0; k < scallops; ++k) {
            const double scallop = kLeast * std::pow(kMost / kLeast, (k + 0.5) / scallops);
            const Job job = job_for(each.surface, scallop);
            const PlannedOperation planned =
                plan_adaptive_isocurve(job, job.operations.front()).front();
            CHECK(planned.stats.scallop_bound_mm <= scallop);
            CHECK(planned.stats.warnings.empty());
            const double share = count(planned.stats, "cells_share");
            some += share > 0 ? 1 : 0;
            most = std::max(most, share);
            longer = std::max(longer, count(planned.stats, "pass_length_mm") /
                                          least_length(each.surface, scallop));
        }
        std::printf("%s: cells at %d of %d scallops, of %.4f of it at most; %.3f of the least\n",
                    each.name, some, scallops, most, longer);
        CHECK(most < 0.02);
        CHECK(longer < each.longer);
    }
}

}  // namespace cusp::test
