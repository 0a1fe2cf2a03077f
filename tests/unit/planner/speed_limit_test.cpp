// The cap of the speed in double: it is kept, and a thousandth more is not.
#include "firmware/planner/speed_limit.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kLimitSeed = 1717;
constexpr int kLimitCases = 5000;

struct Limited {
    PathDerivatives path;
    MachineLimits limits;
    float centripetal;
    float speed;
};

// Greatest share that a speed uses of what the cap is to keep.
double use(const Limited& one, double speed)
{
    double most = speed / static_cast<double>(one.speed);
    double bend = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const auto first = static_cast<double>(one.path.first[i]);
        const auto second = static_cast<double>(one.path.second[i]);
        const auto third = static_cast<double>(one.path.third[i]);
        most = std::max(most, first * speed / static_cast<double>(one.limits.velocity[i]));
        most = std::max(most, second * speed * speed /
                                  (0.92 * static_cast<double>(one.limits.acceleration[i])));
        most = std::max(
            most, third * speed * speed * speed / (0.5 * static_cast<double>(one.limits.jerk[i])));
        bend += second * second;
    }
    return std::max(most, std::sqrt(bend) * speed * speed / static_cast<double>(one.centripetal));
}

}  // namespace

TEST_GROUP(SpeedLimit){};

TEST(SpeedLimit, a_cap_is_the_greatest_speed_that_keeps_all)
{
    std::mt19937_64 random{kLimitSeed};
    const auto between = [&random](float low, float high) {
        return std::exp(
            std::uniform_real_distribution<float>{std::log(low), std::log(high)}(random));
    };
    for (int n = 0; n < kLimitCases; ++n) {
        Limited one{};
        for (unsigned i = 0; i < kAxisCount; ++i) {
            one.path.first[i] = between(0.01F, 1);
            one.path.second[i] = random() % 4 == 0 ? 0 : between(1e-4F, 10);
            one.path.third[i] = random() % 4 == 0 ? 0 : between(1e-4F, 100);
            one.limits.velocity[i] = between(10, 500);
            one.limits.acceleration[i] = between(50, 10000);
            one.limits.jerk[i] = between(1000, 1e6F);
        }
        one.centripetal = between(10, 1e6F);
        one.speed = between(1, 1000);
        const double cap = std::sqrt(static_cast<double>(
            squared_cap(to_lanes(one.path), one.limits, one.centripetal, one.speed)));
        const std::string which = "case " + std::to_string(n);
        CHECK_TEXT(use(one, 0.9999 * cap) <= 1, which.c_str());
        CHECK_TEXT(use(one, 1.001 * cap) > 1, which.c_str());
    }
}
