// Sine, cosine and arc tangent: argument reduction and polynomials, all in plain arithmetic.
#include "firmware/base/math.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cusp {
namespace {

// pi/2 in three parts: k times the first two is exact for |k| < 2^20 (Cody and Waite, 1980).
constexpr double kHalfPi1 = 1.57079632673412561417e+00;
constexpr double kHalfPi2 = 6.07710050630396597660e-11;
constexpr double kHalfPi3 = 2.02226624879595063154e-21;

// Taylor polynomials on [-pi/4, pi/4]: the first term left out is below 5e-18.
double sin_reduced(double x) noexcept
{
    const double z = x * x;
    double sum = 1.0 / 355687428096000.0;
    sum = sum * z - 1.0 / 1307674368000.0;
    sum = sum * z + 1.0 / 6227020800.0;
    sum = sum * z - 1.0 / 39916800.0;
    sum = sum * z + 1.0 / 362880.0;
    sum = sum * z - 1.0 / 5040.0;
    sum = sum * z + 1.0 / 120.0;
    sum = sum * z - 1.0 / 6.0;
    return x + x * z * sum;
}

double cos_reduced(double x) noexcept
{
    const double z = x * x;
    double sum = 1.0 / 20922789888000.0;
    sum = -sum * z + 1.0 / 87178291200.0;
    sum = sum * z - 1.0 / 479001600.0;
    sum = sum * z + 1.0 / 3628800.0;
    sum = sum * z - 1.0 / 40320.0;
    sum = sum * z + 1.0 / 720.0;
    sum = sum * z - 1.0 / 24.0;
    return 1.0 - (0.5 * z - z * z * -sum);
}

template <class T>
SinCos<T> rotate_by_quadrants(T sine, T cosine, std::int32_t quadrant) noexcept
{
    switch (static_cast<std::uint32_t>(quadrant) & 3U) {
        case 0:
            return {sine, cosine};
        case 1:
            return {cosine, -sine};
        case 2:
            return {-sine, -cosine};
        default:
            return {-cosine, sine};
    }
}

}  // namespace

SinCos<double> sin_cos(double angle) noexcept
{
    const double k = std::floor(angle * (2.0 / kPi) + 0.5);
    const double reduced = ((angle - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
    return rotate_by_quadrants(sin_reduced(reduced), cos_reduced(reduced),
                               static_cast<std::int32_t>(k));
}

SinCos<float> sin_cos(float angle) noexcept
{
    // pi/2 in three floats: k times the first two is exact for |k| < 2^12.
    constexpr float kPart1 = 1.5703125F;
    constexpr float kPart2 = 4.83751297e-4F;
    constexpr float kPart3 = 7.54978995e-8F;
    // Rounded down without the library's floor: the argument is far within an int32.
    const float turns = quarter_turns(angle);
    const auto cut = static_cast<std::int32_t>(turns);
    const std::int32_t quadrant = static_cast<float>(cut) > turns ? cut - 1 : cut;
    const auto k = static_cast<float>(quadrant);
    const float x = ((angle - k * kPart1) - k * kPart2) - k * kPart3;
    const auto [sine, cosine] = sin_cos_near_zero(x);
    return rotate_by_quadrants(sine, cosine, quadrant);
}

namespace {

// Arc tangent of t in [0, tan(pi/16)]: the first term left out is below 2e-18.
double atan_reduced(double t) noexcept
{
    const double z = t * t;
    double sum = 0.0;
    for (int n = 21; n >= 3; n -= 2) {
        sum = z * (1.0 / n - sum);
    }
    return t - t * sum;
}

}  // namespace

double atan2(double y, double x) noexcept
{
    const double a = std::fabs(x);
    const double b = std::fabs(y);
    if (a == 0 && b == 0) {
        return 0;
    }
    // Into the first octant, then down to at most pi/16 by subtracting a multiple of pi/8.
    double t = b <= a ? b / a : a / b;
    constexpr double kTanEighth = 0.41421356237309504880;      // tan(pi/8)
    constexpr double kTanSixteenth = 0.19891236737965800691;   // tan(pi/16)
    constexpr double kTan3Sixteenth = 0.66817863791929891999;  // tan(3 pi/16)
    double offset = 0;
    if (t > kTan3Sixteenth) {
        t = (t - 1) / (1 + t);
        offset = kPi / 4;
    } else if (t > kTanSixteenth) {
        t = (t - kTanEighth) / (1 + t * kTanEighth);
        offset = kPi / 8;
    }
    double angle = offset + atan_reduced(t);
    if (b > a) {
        angle = kPi / 2 - angle;
    }
    if (x < 0) {
        angle = kPi - angle;
    }
    return y < 0 ? -angle : angle;
}

// Newton's steps on v^3 = q, from a start with v^3 >= q: a third of the exponent is within 3.5 % of the
// root.
float cube_root(float q) noexcept
{
    constexpr std::uint32_t kTwoThirdsOfBias = 709'921'077;  // Kahan's
    constexpr float kAbove = 1.037F;
    std::uint32_t bits;
    __builtin_memcpy(&bits, &q, sizeof(bits));
    bits = bits / 3 + kTwoThirdsOfBias;
    float v;
    __builtin_memcpy(&v, &bits, sizeof(v));
    v *= kAbove;
    for (int i = 0; i < 8; ++i) {
        const float next = (2.0F * v + q / (v * v)) / 3.0F;
        if (next >= v) {
            break;
        }
        v = next;
    }
    return v;
}

}  // namespace cusp
