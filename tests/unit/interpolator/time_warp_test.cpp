// Holds, overrides and resumes of a plan by its time: no difference of set points over a limit.
#include "firmware/interpolator/time_warp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/base/path_units.hpp"

using namespace cusp;
using namespace cusp::interpolator;

namespace {

constexpr std::uint64_t kWarpSeed = 9090;
constexpr int kWarpCases = 150;
constexpr int kTicks = 4000;
constexpr double kCell = 0.005;   // s
constexpr double kShare = 0.995;  // of the jerk that a plan uses

// Each axis is a sum of waves, scaled until a limit is used up.
class WavePlan {
public:
    WavePlan(std::mt19937_64& random, const MachineLimits& limits) : limits_{limits}
    {
        for (unsigned i = 0; i < kAxisCount; ++i) {
            const double ramp =
                static_cast<double>(limits.acceleration[i]) / static_cast<double>(limits.jerk[i]);
            for (Wave& wave : waves_[i]) {
                wave.rate = std::uniform_real_distribution<double>{0.02, 1.2}(random) / ramp;
                wave.phase = std::uniform_real_distribution<double>{0, 6.28}(random);
                wave.size = 1 / (wave.rate * wave.rate);
            }
            double most = 0;
            for (double t = 0; t < 1e-3 * kTicks; t += 5e-4) {
                most = std::max(
                    {most, std::fabs(at(i, t, 1)) / static_cast<double>(limits.velocity[i]),
                     std::fabs(at(i, t, 2)) / static_cast<double>(limits.acceleration[i]),
                     std::fabs(at(i, t, 3)) / static_cast<double>(limits.jerk[i])});
            }
            for (Wave& wave : waves_[i]) {
                wave.size *= kShare / most;
            }
        }
    }

    // The place of an axis, or a derivative of it.
    double at(unsigned axis, double t, int order) const
    {
        double sum = 0;
        for (const Wave& wave : waves_[axis]) {
            sum += wave.size * std::pow(wave.rate, order) *
                   std::sin(wave.rate * t + wave.phase + 1.5707963267948966 * order);
        }
        return sum;
    }

    WarpBounds bounds(double from) const
    {
        AxisVecf speed{};
        AxisVecf braking = MachineLimits::as_x(1, 1, 1);
        AxisVecf speeding = MachineLimits::as_x(-1, -1, -1);
        AxisVecf falling = MachineLimits::as_x(1, 1, 1);
        AxisVecf rising = MachineLimits::as_x(-1, -1, -1);
        for (unsigned i = 0; i < kAxisCount; ++i) {
            for (int k = 0; k <= 10; ++k) {
                const double t = from + kCell * k / 10;
                const double v = at(i, t, 1);
                const auto a =
                    static_cast<float>((v < 0 ? -1 : 1) * at(i, t, 2)) / limits_.acceleration[i];
                speed[i] =
                    std::max(speed[i], static_cast<float>(std::fabs(v)) / limits_.acceleration[i]);
                braking[i] = std::min(braking[i], a);
                speeding[i] = std::max(speeding[i], a);
                const auto j = static_cast<float>((v < 0 ? -1 : 1) * at(i, t, 3)) / limits_.jerk[i];
                falling[i] = std::min(falling[i], j);
                rising[i] = std::max(rising[i], j);
            }
        }
        return {to_lanes(speed),  to_lanes(braking), to_lanes(speeding),       to_lanes(falling),
                to_lanes(rising), all_lanes(0.0F),   static_cast<float>(kCell)};
    }

private:
    struct Wave {
        double size, rate, phase;
    };
    MachineLimits limits_;
    std::array<std::array<Wave, 3>, kAxisCount> waves_{};
};

MachineLimits any_limits(std::mt19937_64& random)
{
    MachineLimits limits;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const auto between = [&random](double low, double high) {
            return static_cast<float>(std::exp(
                std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random)));
        };
        limits.velocity[i] = between(20, 500);
        limits.acceleration[i] = limits.velocity[i] * between(4, 20);
        limits.jerk[i] = limits.acceleration[i] * between(10, 100);
    }
    return limits;
}

// Of the limits, by differences of the places at these times.
double largest_use(const WavePlan& plan,
                   const std::vector<double>& times,
                   const MachineLimits& limits)
{
    double most = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const auto at = [&](std::size_t k) {
            return plan.at(i, times[k], 0);
        };
        for (std::size_t k = 3; k < times.size(); ++k) {
            const double v = at(k) - at(k - 1);
            const double a = at(k) - 2 * at(k - 1) + at(k - 2);
            const double j = at(k) - 3 * at(k - 1) + 3 * at(k - 2) - at(k - 3);
            most = std::max({most, std::fabs(v) * 1e3 / static_cast<double>(limits.velocity[i]),
                             std::fabs(a) * 1e6 / static_cast<double>(limits.acceleration[i]),
                             std::fabs(j) * 1e9 / static_cast<double>(limits.jerk[i])});
        }
    }
    return most;
}

}  // namespace

TEST_GROUP(TimeWarp){};

TEST(TimeWarp, no_change_of_the_rate_breaks_a_limit)
{
    double longest = 0;
    double sum = 0;
    int holds = 0;
    for (int n = 0; n < kWarpCases; ++n) {
        const std::string which = "case " + std::to_string(n);
        std::mt19937_64 random{kWarpSeed + static_cast<std::uint64_t>(n)};
        const MachineLimits limits = any_limits(random);
        const WavePlan plan{random, limits};
        double stop = 0;
        double ramp = 0;
        for (unsigned i = 0; i < kAxisCount; ++i) {
            stop = std::max(stop, static_cast<double>(limits.velocity[i]) /
                                      static_cast<double>(limits.acceleration[i]));
            ramp = std::max(ramp, static_cast<double>(limits.acceleration[i]) /
                                      static_cast<double>(limits.jerk[i]));
        }
        std::vector<WarpBounds> cells;
        for (int k = 0; k * kCell < 1e-3 * kTicks; ++k) {
            cells.push_back(plan.bounds(k * kCell));
        }
        TimeWarp warp;
        warp.set_limits(limits);
        std::vector<double> times{0, 1e-3, 2e-3};
        double target = 1;
        int since = 0;
        for (int tick = 0; tick < kTicks && times.back() < 1e-3 * kTicks - 1; ++tick) {
            if (random() % 300 == 0) {
                const double targets[] = {0, 0, 0.3, 0.6, 1};
                target = warp.rate() < 0.5F ? 1 : targets[random() % 5];
                warp.set_target(static_cast<float>(target));
                since = 0;
            }
            const auto first = static_cast<std::size_t>(std::max(times.back() - 1e-3, 0.0) / kCell);
            const auto count =
                static_cast<std::size_t>(2 + static_cast<double>(warp.reach()) / kCell);
            const bool was_settled = warp.settled();
            times.push_back(times.back() +
                            static_cast<double>(warp.advance({cells.data() + first, count})));
            ++since;
            if (!was_settled && warp.settled() && target <= 0) {
                longest = std::max(longest, 1e-3 * since / (stop + ramp));
                sum += 1e-3 * since / (stop + ramp);
                ++holds;
            }
        }
        const double use = largest_use(plan, times, limits);
        CHECK_TEXT(use < 1, (which + ": " + std::to_string(use)).c_str());
    }
    CHECK(holds > kWarpCases);
    CHECK_TEXT(sum < 0.85 * holds, std::to_string(sum / holds).c_str());
    CHECK_TEXT(longest < 2, std::to_string(longest).c_str());
}
