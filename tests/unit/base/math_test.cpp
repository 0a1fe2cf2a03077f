#include "firmware/base/math.hpp"

#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

namespace {
constexpr int kCases = 200000;
constexpr unsigned kSeed = 1;
}  // namespace

TEST_GROUP(Math) { std::mt19937_64 random{kSeed}; };

TEST(Math, SinCosIsWithin1e15OfLongDouble)
{
    std::uniform_real_distribution<double> angles{-100, 100};
    for (int i = 0; i < kCases; ++i) {
        const double angle = angles(random);
        const auto [sine, cosine] = cusp::sin_cos(angle);
        DOUBLES_EQUAL(static_cast<double>(sinl(angle)), sine, 1e-15);
        DOUBLES_EQUAL(static_cast<double>(cosl(angle)), cosine, 1e-15);
    }
}

TEST(Math, FloatSinCosIsWithinItsBound)
{
    std::uniform_real_distribution<float> angles{-8, 8};
    for (int i = 0; i < kCases; ++i) {
        const float angle = angles(random);
        const auto [sine, cosine] = cusp::sin_cos(angle);
        DOUBLES_EQUAL(std::sin(static_cast<double>(angle)), static_cast<double>(sine), 1.2e-7);
        DOUBLES_EQUAL(std::cos(static_cast<double>(angle)), static_cast<double>(cosine), 1.2e-7);
    }
}

TEST(Math, Atan2IsWithinItsBoundInAllQuadrants)
{
    std::uniform_real_distribution<double> coordinates{-1, 1};
    for (int i = 0; i < kCases; ++i) {
        const double x = coordinates(random);
        const double y = coordinates(random);
        DOUBLES_EQUAL(static_cast<double>(atan2l(y, x)), cusp::atan2(y, x), 5e-16);
    }
    DOUBLES_EQUAL(0, cusp::atan2(0, 0), 0);
    DOUBLES_EQUAL(cusp::kPi, cusp::atan2(0, -1), 0);
}

TEST(Math, CubeRootIsNearlyExact)
{
    std::uniform_real_distribution<double> exponents{-18, 18};
    for (int i = 0; i < kCases; ++i) {
        const auto q = static_cast<float>(std::pow(10.0, exponents(random)));
        const double root = std::cbrt(static_cast<double>(q));
        DOUBLES_EQUAL(1, static_cast<double>(cusp::cube_root(q)) / root, 1e-6);
    }
}
