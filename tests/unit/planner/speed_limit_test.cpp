// The speed limit of a stretch holds for every axis, at every speed up to the cap.
#include "firmware/planner/speed_limit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kLimitSeed = 7301;
constexpr float kFilterTime = 0.02F;
constexpr float kHalfFilter = 0.5F * kFilterTime;

double between(std::mt19937_64& random, double low, double high)
{
    return std::exp(std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random));
}

Vec3f any_vector(std::mt19937_64& random, double low, double high)
{
    Vec3f v{};
    for (unsigned i = 0; i < 3; ++i) {
        v[i] = random() % 4 == 0 ? 0.0F : static_cast<float>(between(random, low, high));
    }
    return v;
}

// Random bounds of a stretch; one axis goes along the path.
PathDerivatives any_path(std::mt19937_64& random)
{
    PathDerivatives path{any_vector(random, 0.01, 1), any_vector(random, 1e-4, 20),
                         any_vector(random, 1e-6, 400)};
    path.first[static_cast<unsigned>(random() % 3)] = 1.0F;
    return path;
}

// True if every axis is within its limits at the speed v of the tool, mm/s, with the acceleration u.
bool holds(const PathDerivatives& path, double v, double u)
{
    const MachineLimits limits{};
    bool all = true;
    for (unsigned i = 0; i < 3; ++i) {
        const double first = static_cast<double>(path.first[i]);
        const double second = static_cast<double>(path.second[i]);
        const double third = static_cast<double>(path.third[i]);
        const double acceleration = first * u + second * v * v;
        const double jerk = first * u / kFilterTime + 3 * second * v * u + third * v * v * v;
        all = all && first * v <= 1.0001 * static_cast<double>(limits.velocity[i]) &&
              acceleration <= 1.0001 * static_cast<double>(limits.acceleration[i]) &&
              jerk <= 1.0001 * static_cast<double>(limits.jerk[i]);
    }
    return all;
}

}  // namespace

TEST_GROUP(SpeedLimit){};

TEST(SpeedLimit, KeepsEveryAxisWithinItsLimitsThoughTheToolIsFaster)
{
    std::mt19937_64 random{kLimitSeed};
    for (int k = 0; k < 5000; ++k) {
        const PathDerivatives path = any_path(random);
        const SpeedLimit limit = speed_limit(
            allowance(to_lanes(path), {}, kFilterTime, kUnlimited, 2000.0F), kHalfFilter);
        CHECK(limit.least >= 0);
        const double greatest = std::sqrt(static_cast<double>(limit.cap));
        for (int step = 0; step <= 40; ++step) {
            const double v = greatest * step / 40;
            const double u =
                static_cast<double>(limit.acceleration_at(static_cast<float>(v), kHalfFilter));
            const double faster = std::min(v + static_cast<double>(kHalfFilter) * u, greatest);
            const std::string which = "seed " + std::to_string(kLimitSeed) + ", case " +
                                      std::to_string(k) + ", step " + std::to_string(step);
            CHECK_TEXT(holds(path, v, u) && holds(path, faster, u), which.c_str());
        }
    }
}

// The exact limit of the axes if the tool is faster by half a filter of it, by bisection.
TEST(SpeedLimit, AllowsNearlyAllThatTheAxesDoWhereOneBendsAlone)
{
    for (const float third : {0.01F, 0.3F, 10.0F}) {
        const PathDerivatives path{{1, 0, 0}, {}, {third, 0, 0}};
        const SpeedLimit limit = speed_limit(
            allowance(to_lanes(path), {}, kFilterTime, kUnlimited, 2000.0F), kHalfFilter);
        const double greatest = std::sqrt(static_cast<double>(limit.cap));
        for (int step = 0; step <= 40; ++step) {
            const double v = greatest * step / 40;
            double low = 0;
            double high = 1000;
            for (int i = 0; i < 40; ++i) {
                const double u = 0.5 * (low + high);
                const double faster = std::min(v + static_cast<double>(kHalfFilter) * u, greatest);
                (holds(path, faster, u) ? low : high) = u;
            }
            const double u =
                static_cast<double>(limit.acceleration_at(static_cast<float>(v), kHalfFilter));
            CHECK_TEXT(u >= 0.95 * low, std::to_string(u / low).c_str());
        }
    }
}

TEST(SpeedLimit, ALineMayUseAllOfItsAxis)
{
    const PathDerivatives along_x{{1, 0, 0}, {}, {}};
    const SpeedLimit limit = speed_limit(
        allowance(to_lanes(along_x), {}, kFilterTime, kUnlimited, 2000.0F), kHalfFilter);
    DOUBLES_EQUAL(100.0 * 100.0, static_cast<double>(limit.cap), 0.1);
    DOUBLES_EQUAL(1000.0, static_cast<double>(limit.at_rest), 0.01);
    DOUBLES_EQUAL(1000.0, static_cast<double>(limit.least), 0.01);
}

TEST(SpeedLimit, WhatIsStricterThanTwoBindsBoth)
{
    std::mt19937_64 random{kLimitSeed + 1};
    for (int k = 0; k < 2000; ++k) {
        const auto any = [&random] {
            const PathDerivatives path{any_vector(random, 0.1, 1), any_vector(random, 1e-3, 5),
                                       any_vector(random, 1e-4, 40)};
            return allowance(to_lanes(path), {}, kFilterTime, kUnlimited, 300.0F);
        };
        const Allowance a = any();
        const Allowance b = any();
        Allowance both = a;
        restrict_to(both, b);
        CHECK(!binds(a, both) || a.cap == both.cap);
        CHECK(both.cap <= a.cap);
        for (int step = 0; step <= 8; ++step) {
            const float square = both.cap * 0.125F * static_cast<float>(step);
            const auto at = [square](const Line& line, float cap) {
                return line.at_rest + (line.at_cap - line.at_rest) * square / cap;
            };
            const auto bent_at = [square](const BentLine& bent, float cap) {
                const float halves = 2.0F * square / cap;
                return halves < 1.0F ? bent.at_rest + (bent.at_half - bent.at_rest) * halves
                                     : bent.at_half + (bent.at_cap - bent.at_half) * (halves - 1);
            };
            CHECK(at(both.by_acceleration, both.cap) <=
                  at(a.by_acceleration, a.cap) * 1.0001F + 0.01F);
            CHECK(bent_at(both.by_jerk, both.cap) <= bent_at(a.by_jerk, a.cap) * 1.0001F + 0.01F);
        }
    }
}

TEST(SpeedLimit, AFeedAloneRestrictsToTheSameBits)
{
    std::mt19937_64 random{kLimitSeed + 2};
    const auto any = [&random](unsigned k) {
        const PathDerivatives path{any_vector(random, 0.1, 1), any_vector(random, 1e-3, 5),
                                   any_vector(random, 1e-4, 40)};
        Allowance allowed = allowance(to_lanes(path), {}, kFilterTime, kUnlimited, 300.0F);
        allowed.feed = std::uniform_real_distribution<float>{1, 1e4F}(random);
        const auto share = [&random] {
            return std::uniform_real_distribution<float>{0.02F, 1}(random);
        };
        if (k % 3 != 0) {
            const float at_cap = share();
            allowed.jerk_left = {k % 3 == 1 ? at_cap : share(), at_cap};
            allowed.acceleration_left = share();
        }
        return allowed;
    };
    const auto same_bits = [](const Allowance& a, const Allowance& b) {
        return std::memcmp(&a, &b, sizeof(Allowance)) == 0;
    };
    for (unsigned k = 0; k < 5000; ++k) {
        Allowance feed = kAllowsAll;
        feed.feed = any(0).feed;
        Allowance one = any(k);
        Allowance other = one;
        for (unsigned i = 0; i < 2; ++i) {
            CHECK_EQUAL(feed.feed < one.feed, binds(feed, one));
            restrict_to(one, feed);
            restrict_to_feed(other, feed.feed);
            CHECK(same_bits(one, other));
            restrict_to(one, any(k + 1));
            other = one;
        }
    }
}
