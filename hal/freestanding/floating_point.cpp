// sqrt, fabs, floor and ceil for images without a C library: the only functions of libm that
// firmware calls. Their results are exact, so that they are the host's bit for bit.
#include <cstdint>

#include "hal/freestanding/soft_root.hpp"

namespace {

template <class To, class From>
To same_bits(From from)
{
    static_assert(sizeof(To) == sizeof(From));
    To to;
    __builtin_memcpy(&to, &from, sizeof to);
    return to;
}

}  // namespace

extern "C" {

double sqrt(double x);
double floor(double x);
float floorf(float x);
double ceil(double x);
double fabs(double x);
float ceilf(float x);

double sqrt(double x)
{
    return same_bits<double>(cusp::hal::square_root_bits(same_bits<std::uint64_t>(x)));
}

double floor(double x)
{
    return same_bits<double>(cusp::hal::floor_bits(same_bits<std::uint64_t>(x)));
}

float floorf(float x)
{
    // Beyond 2^23 every float is whole.
    constexpr float kWhole = 8388608.0F;
    if (!(x > -kWhole && x < kWhole) || x == 0.0F) {
        return x;
    }
    const auto truncated = static_cast<float>(static_cast<std::int32_t>(x));
    return truncated > x ? truncated - 1.0F : truncated;
}

double ceil(double x) { return -floor(-x); }
double fabs(double x)
{
    return same_bits<double>(same_bits<std::uint64_t>(x) & 0x7FFFFFFFFFFFFFFFU);
}
float ceilf(float x) { return -floorf(-x); }
}
