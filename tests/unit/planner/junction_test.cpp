// The share of the axes' limits used by a junction, against the axis filters themselves.
#include "firmware/planner/junction.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

struct Largest {
    double acceleration;
    double jerk;
};

// The filters, in long double, on one axis that turns from slope 0 to `turn` at the speed v.
Largest filtered(double v, double turn, AxisFilter filter)
{
    std::vector<double> p(120);
    for (std::size_t k = 60; k < p.size(); ++k) {
        p[k] = v * 1e-3 * turn * static_cast<double>(k - 60);
    }
    const auto box = [](const std::vector<double>& in, std::size_t n) {
        std::vector<double> out(in.size());
        for (std::size_t k = n; k < in.size(); ++k) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) {
                sum += in[k - i];
            }
            out[k] = sum / static_cast<double>(n);
        }
        return out;
    };
    const auto out = box(box(p, filter.first), filter.second);
    Largest largest{};
    for (std::size_t k = 30; k + 2 < out.size(); ++k) {
        const double second = out[k + 1] - 2 * out[k] + out[k - 1];
        const double third = out[k + 2] - 3 * out[k + 1] + 3 * out[k] - out[k - 1];
        largest.acceleration = std::max(largest.acceleration, std::fabs(second) * 1e6);
        largest.jerk = std::max(largest.jerk, std::fabs(third) * 1e9);
    }
    return largest;
}

}  // namespace

TEST_GROUP(Junctions){};

TEST(Junctions, TheFiltersKeepTheSharesOfATurn)
{
    const MachineLimits limits{};
    for (const AxisFilter filter : {AxisFilter{4, 2}, AxisFilter{5, 2}, AxisFilter{10, 2}}) {
        for (const float turn : {0.0002F, 0.001F, 0.004F, 0.008F}) {
            const Junction junction{{0, turn, 0}, {}, {}, {}, turn};
            const JunctionShare share =
                junction_share(JunctionRun{junction}, limits, filter, 0.98F, 200.0F, {0.0045F});
            const Largest largest =
                filtered(static_cast<double>(share.speed), static_cast<double>(turn), filter);
            CHECK(largest.acceleration <=
                  1.001 * static_cast<double>(share.acceleration * limits.acceleration.y));
            CHECK(largest.jerk <= 1.001 * static_cast<double>(share.jerk * limits.jerk.y));
            CHECK(share.jerk <= 0.98F);
        }
    }
}

TEST(Junctions, TheLineOfSharesIsAboveTheShareAtLowerSpeeds)
{
    const MachineLimits limits{};
    const AxisFilter filter{10, 2};
    const Vec3f second{0.05F, 0.05F, 0.05F};
    const Vec3f third = second * 0.05F;
    const Junction junction{{0, 0.001F, 0}, {0.02F, 0.03F, 0}, second, third, 0.001F};
    const JunctionShare fast =
        junction_share(JunctionRun{junction}, limits, filter, 0.98F, 120.0F, {0.0045F});
    for (int k = 1; k < 10; ++k) {
        const float part = 0.1F * static_cast<float>(k);
        const JunctionShare slow = junction_share(JunctionRun{junction}, limits, filter, 0.98F,
                                                  fast.speed * std::sqrt(part), {0.0045F});
        CHECK(slow.jerk <= fast.jerk_at_rest + (fast.jerk - fast.jerk_at_rest) * part + 1e-5F);
    }
}

TEST(Junctions, ACornerWithinTheDeviationOnly)
{
    const Junction junction{{0, 0.008F, 0}, {}, {}, {}, 0.008F};
    const JunctionShare share =
        junction_share(JunctionRun{junction}, {}, {10, 2}, 0.98F, 200.0F, {1e-5F});
    // Half of v turn times the mean of |t| under the filters.
    const double off = 0.5 * static_cast<double>(share.speed) * 0.008 * (0.0025 + 0.002 / 12);
    CHECK(off <= 1.001e-5);
}

// A stretch nearby whose own cap is far below 100 mm/s is not passed at 100 mm/s: it leaves what its
// cap leaves.
TEST(Junctions, ARoundedJointBesideATightBendIsPassedAtFullSpeed)
{
    const Vec3f second{2.0F, 2.0F, 0};
    const Vec3f third{8.0F, 8.0F, 0};
    const Junction junction{{1e-6F, 1e-6F, 0}, {1e-5F, 1e-5F, 0}, second, third, 1.4e-6F};
    const JunctionShare share =
        junction_share(JunctionRun{junction}, {}, {10, 2}, 0.98F, 100.0F, {0.0045F});
    DOUBLES_EQUAL(100.0, static_cast<double>(share.speed), 0);
    CHECK(share.jerk < 1e-2F);
}
