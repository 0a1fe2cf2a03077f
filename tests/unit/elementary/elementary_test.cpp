#include "host_tools/base/elementary/elementary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>

#include "CppUTest/TestHarness.h"

namespace {

namespace elementary = cusp::elementary;

using Function = double (*)(double, double);

struct Named {
    const char* name;
    Function function;
    double most_ulps;
    double most;  // size of the arguments of the sum
    std::uint64_t bits_sum;
};

// The sums are those of x86-64; this test also runs on riscv64, and the engine's in WebAssembly.
const Named kFunctions[] = {
    {"sin", [](double x, double) { return elementary::sin(x); }, 1, 1e3, 0x542d0446bb78dd79},
    {"cos", [](double x, double) { return elementary::cos(x); }, 1, 1e3, 0x2aa3c912a8d5213d},
    {"tan", [](double x, double) { return elementary::tan(x); }, 1, 1e3, 0xf2bc2bf0d9343ed0},
    {"asin", [](double x, double) { return elementary::asin(x); }, 1, 1, 0x4fab543e0d33d528},
    {"acos", [](double x, double) { return elementary::acos(x); }, 1, 1, 0xbef5649c1291a788},
    {"atan", [](double x, double) { return elementary::atan(x); }, 1, 10, 0x3297aa9b2021f81e},
    {"cbrt", [](double x, double) { return elementary::cbrt(x); }, 1, 1e4, 0x20f591b0fb560978},
    {"atan2", elementary::atan2, 1, 100, 0x409dd94b3bd00be1},
    {"hypot", [](double y, double x) { return elementary::hypot(x, y); }, 1.5, 100,
     0x3e08f5c9fbf3829c},
};

double ulp_of(double value)
{
    int exponent = 0;
    (void)std::frexp(value, &exponent);
    return std::ldexp(1.0, std::max(exponent, -1021) - 53);
}

// Numbers that every C++ library draws alike.
double draw(std::mt19937_64& random, double most)
{
    return (std::ldexp(static_cast<double>(random() >> 11U), -52) - 1) * most;
}

// FNV-1a of the results' bytes.
std::uint64_t sum_of_bits(const Named& f)
{
    std::mt19937_64 random{1};
    std::uint64_t sum = 0xcbf29ce484222325U;
    for (int n = 0; n < 1000; ++n) {
        const double y = draw(random, f.most);
        const double value = f.function(y, draw(random, f.most));
        std::uint64_t bits{};
        std::memcpy(&bits, &value, sizeof bits);
        for (unsigned byte = 0; byte < 8; ++byte) {
            sum = (sum ^ (bits >> 8U * byte & 0xffU)) * 0x100000001b3U;
        }
    }
    return sum;
}

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_GROUP(Elementary){};

TEST(Elementary, ResultsAreWithinAnUlpOfTrueOnes)
{
    std::ifstream in{CUSP_SOURCE_DIR "/tests/unit/elementary/known_values.txt"};
    int cases = 0;
    for (std::string line; std::getline(in, line); ++cases) {
        std::istringstream words{line};
        std::string name, y, x, truth;
        words >> name >> y >> x >> truth;
        for (const Named& f : kFunctions) {
            if (name == f.name) {
                const double right = std::strtod(truth.c_str(), nullptr);
                const double value =
                    f.function(std::strtod(y.c_str(), nullptr), std::strtod(x.c_str(), nullptr));
                // the truth is rounded, too
                if (!(std::fabs(value - right) <= f.most_ulps * ulp_of(right))) {
                    std::printf("%s: %a\n", line.c_str(), value);
                    FAIL("too far from the true value");
                }
            }
        }
    }
    CHECK_TRUE(cases == 990);
}

TEST(Elementary, BitsAreThoseOfEveryOtherMachine)
{
    for (const Named& f : kFunctions) {
        const std::uint64_t sum = sum_of_bits(f);
        if (sum != f.bits_sum) {
            std::printf("%s: sum of bits 0x%016llx\n", f.name,
                        static_cast<unsigned long long>(sum));
            FAIL("other bits than on x86-64");
        }
    }
}

TEST(Elementary, SignsOfZerosDecideTheHalfTurn)
{
    const double half_turn = elementary::acos(-1);
    CHECK_TRUE(elementary::atan2(0.0, -1) == half_turn);
    CHECK_TRUE(elementary::atan2(-0.0, -1) == -half_turn);
    CHECK_TRUE(elementary::atan2(0.0, -0.0) == half_turn);
    CHECK_TRUE(elementary::atan2(0.0, 0.0) == 0);
    CHECK_TRUE(std::signbit(elementary::atan2(-0.0, 1)));
    CHECK_TRUE(std::signbit(elementary::sin(-0.0)));
    CHECK_TRUE(elementary::atan2(2, 0) == half_turn / 2);
}

TEST(Elementary, InfiniteCoordinatesHaveDirections)
{
    const double half_turn = elementary::acos(-1);
    CHECK_TRUE(elementary::atan2(kInfinity, kInfinity) == half_turn / 4);
    CHECK_TRUE(elementary::atan2(1, -kInfinity) == half_turn);
    CHECK_TRUE(elementary::atan2(-kInfinity, 1) == -half_turn / 2);
    CHECK_TRUE(elementary::hypot(kInfinity, kNan) == kInfinity);
}

TEST(Elementary, WhatIsNoNumberStaysNone)
{
    for (const Named& f : kFunctions) {
        CHECK_TRUE(std::isnan(f.function(kNan, 1)));
    }
    CHECK_TRUE(std::isnan(elementary::acos(1.0000000000000002)));
    CHECK_TRUE(std::isnan(elementary::asin(-2)));
    CHECK_TRUE(std::isnan(elementary::sin(kInfinity)));
}

TEST(Elementary, LengthsOfAnySizeNeitherOverflowNorVanish)
{
    for (const double unit : {0x1p700, 0x1p-700, 0x1p-1070}) {
        CHECK_TRUE(elementary::hypot(3 * unit, -4 * unit) == 5 * unit);
    }
    CHECK_TRUE(elementary::hypot(0, 0) == 0);
    CHECK_TRUE(elementary::hypot(0, -7) == 7);
}

TEST(Elementary, PowersOfTenAreThoseThatTextsGive)
{
    for (int exponent = -22; exponent <= 22; ++exponent) {
        const std::string text = "1e" + std::to_string(exponent);
        CHECK_TRUE(elementary::power_of_ten(exponent) == std::strtod(text.c_str(), nullptr));
    }
}
