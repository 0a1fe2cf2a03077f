// Square root and floor with integers against the host's.
#include "hal/freestanding/soft_root.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>

#include "CppUTest/TestHarness.h"

namespace {

std::uint64_t bits_of(double x)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}
double double_of(std::uint64_t bits)
{
    double x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}
void check_both(double x)
{
    CHECK_TRUE(bits_of(std::sqrt(x)) == cusp::hal::square_root_bits(bits_of(x)));
    CHECK_TRUE(bits_of(std::floor(x)) == cusp::hal::floor_bits(bits_of(x)));
}

}  // namespace

TEST_GROUP(SoftRoot){};

TEST(SoftRoot, EqualsTheHostBitForBit)
{
    const unsigned seed = 99;
    std::printf(" seed %u", seed);
    std::mt19937_64 random{seed};
    for (unsigned i = 0; i < 100000; ++i) {
        const double any = double_of(random() & 0x7FFFFFFFFFFFFFFFU);
        if (!std::isnan(any)) {
            check_both(any);
        }
        check_both(std::ldexp(static_cast<double>(random() % 4096), -3));
        const double x = std::ldexp(static_cast<double>(random()), -40);
        CHECK_TRUE(bits_of(std::floor(-x)) == cusp::hal::floor_bits(bits_of(-x)));
    }
}

TEST(SoftRoot, EqualsTheHostAtTheEdges)
{
    for (const double x : {0.0, 1.0, 2.0, 4.0, 0.5, 1e-320, 5e-324, 2.2250738585072014e-308,
                           std::numeric_limits<double>::max(), 9007199254740991.0,
                           std::numeric_limits<double>::infinity()}) {
        check_both(x);
    }
    CHECK_TRUE(std::isnan(double_of(cusp::hal::square_root_bits(bits_of(-1.0)))));
    CHECK_TRUE(bits_of(-0.0) == cusp::hal::square_root_bits(bits_of(-0.0)));
    CHECK_TRUE(bits_of(-1.0) == cusp::hal::floor_bits(bits_of(-0.25)));
    CHECK_TRUE(bits_of(-0.0) == cusp::hal::floor_bits(bits_of(-0.0)));
}
