// The speed limit of a stretch holds for every axis, at every speed up to the cap.
#include "firmware/planner/speed_limit.hpp"

#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kLimitSeed = 7301;
constexpr float kFilterTime = 0.02F;

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

}  // namespace

TEST_GROUP(SpeedLimit){};

TEST(SpeedLimit, KeepsAccelerationAndJerkOfEveryAxisUpToTheCap)
{
    std::mt19937_64 random{kLimitSeed};
    const MachineLimits limits{};
    for (int k = 0; k < 5000; ++k) {
        PathDerivatives path{any_vector(random, 0.01, 1), any_vector(random, 1e-4, 20),
                             any_vector(random, 1e-6, 400)};
        path.first[static_cast<unsigned>(random() % 3)] = 1.0F;
        const SpeedLimit limit =
            speed_limit(allowance(path, limits, kFilterTime, kUnlimited, 2000.0F));
        CHECK(limit.u1 >= 0);
        for (int step = 0; step <= 10; ++step) {
            const double square = static_cast<double>(limit.cap) * 0.1 * step;
            const double u = static_cast<double>(limit.acceleration_at(static_cast<float>(square)));
            const double v = std::sqrt(square);
            for (unsigned i = 0; i < 3; ++i) {
                const double first = static_cast<double>(path.first[i]);
                const double second = static_cast<double>(path.second[i]);
                const double third = static_cast<double>(path.third[i]);
                const double acceleration = first * u + second * square;
                const double jerk = first * u / 0.02 + 3 * second * v * u + third * v * v * v;
                const std::string which = "case " + std::to_string(k);
                CHECK_TEXT(first * v <= 1.0001 * static_cast<double>(limits.velocity[i]),
                           which.c_str());
                CHECK_TEXT(acceleration <= 1.0001 * static_cast<double>(limits.acceleration[i]),
                           which.c_str());
                CHECK_TEXT(jerk <= 1.0001 * static_cast<double>(limits.jerk[i]), which.c_str());
            }
        }
    }
}

TEST(SpeedLimit, ALineMayUseAllOfItsAxis)
{
    const PathDerivatives along_x{{1, 0, 0}, {}, {}};
    const SpeedLimit limit = speed_limit(allowance(along_x, {}, kFilterTime, kUnlimited, 2000.0F));
    DOUBLES_EQUAL(100.0 * 100.0, static_cast<double>(limit.cap), 0.1);
    DOUBLES_EQUAL(1000.0, static_cast<double>(limit.u0), 0.01);
    DOUBLES_EQUAL(1000.0, static_cast<double>(limit.u1), 0.01);
}

TEST(SpeedLimit, WhatIsStricterThanTwoBindsBoth)
{
    std::mt19937_64 random{kLimitSeed + 1};
    for (int k = 0; k < 2000; ++k) {
        const auto any = [&random] {
            const PathDerivatives path{any_vector(random, 0.1, 1), any_vector(random, 1e-3, 5),
                                       any_vector(random, 1e-4, 40)};
            return allowance(path, {}, kFilterTime, kUnlimited, 300.0F);
        };
        const Allowance a = any();
        const Allowance b = any();
        const Allowance both = stricter(a, b);
        CHECK(!binds(a, both) || a.cap == both.cap);
        CHECK(both.cap <= a.cap);
        for (int step = 0; step <= 4; ++step) {
            const float square = both.cap * 0.25F * static_cast<float>(step);
            const auto at = [square](const Line& line, float cap) {
                return line.at_rest + (line.at_cap - line.at_rest) * square / cap;
            };
            CHECK(at(both.by_acceleration, both.cap) <=
                  at(a.by_acceleration, a.cap) * 1.0001F + 0.01F);
            CHECK(at(both.by_jerk, both.cap) <= at(a.by_jerk, a.cap) * 1.0001F + 0.01F);
        }
    }
}
