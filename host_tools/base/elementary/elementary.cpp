// Sine, cosine, tangent and roots: arguments reduced exactly, then minimax polynomials.
//
// Polynomials and their order of evaluation are those of musl 1.2 and FreeBSD's msun (k_sin.c, k_cos.c, k_tan.c, s_cbrt.c):
// Copyright (C) 1993, 2004 by Sun Microsystems, Inc. All rights reserved. Permission to use, copy, modify, and distribute
// this software is freely granted, provided that this notice is preserved.
#include "host_tools/base/elementary/elementary.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "host_tools/base/elementary/double_bits.hpp"

namespace cusp::elementary {
namespace {

constexpr double kQuarterTurn = 0.78539816339744830962;  // pi/4
constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kMostReduced = 1.6e6;  // below 2^20 right angles

// An angle within pi/4 of `quarters` right angles: their difference is angle + tail.
struct Reduced {
    double angle;
    double tail;
    unsigned quarters;  // the lowest two bits count
};

// pi/2 in three parts of 33 bits, whose products by whole numbers below 2^20 are exact, and the rest
// (Cody and Waite, 1980).
Reduced reduced(double angle)
{
    if (std::fabs(angle) <= kQuarterTurn) {
        return {angle, 0, 0};
    }
    if (!(std::fabs(angle) < kMostReduced)) {
        angle = std::remainder(angle, kTwoPi);
    }
    constexpr double kPart1 = 1.57079632673412561417e+00;
    constexpr double kPart2 = 6.07710050630396597660e-11;
    constexpr double kPart3 = 2.02226624871116645580e-21;
    constexpr double kRest = 8.47842766036889956997e-32;
    const double turns = std::floor(angle * 0.63661977236758134308 + 0.5);
    const Sum first = sum_of(angle, -turns * kPart1);
    const Sum second = sum_of(first.value, -turns * kPart2);
    const Sum third = sum_of(second.value, -turns * kPart3);
    const double rest = ((first.error + second.error) + third.error) - turns * kRest;
    const double value = third.value + rest;
    // a NaN stays one
    const auto whole = static_cast<std::int64_t>(std::isfinite(turns) ? turns : 0);
    return {value, (third.value - value) + rest, static_cast<unsigned>(whole & 3)};
}

// |x| <= pi/4: error of the polynomial 2^-58.
double sin_near_zero(double x, double tail)
{
    const double z = x * x;
    const double w = z * z;
    const double r = 8.33333333332248946124e-03 +
                     z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                     z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
    const double v = z * x;
    return x - ((z * (0.5 * tail - v * r) - tail) - v * -1.66666666666666324348e-01);
}

double cos_near_zero(double x, double tail)
{
    const double z = x * x;
    const double r = z * (4.16666666666666019037e-02 +
                          z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
                     z * z * (z * z) *
                         (-2.75573143513906633035e-07 +
                          z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
    const double half = 0.5 * z;
    const double w = 1.0 - half;
    return w + (((1.0 - w) - half) + (z * r - x * tail));
}

// A turned sine: quarters of a turn are added to the angle.
double sin_of(const Reduced& at, unsigned quarters)
{
    const unsigned place = at.quarters + quarters;
    const double value =
        (place & 1U) != 0 ? cos_near_zero(at.angle, at.tail) : sin_near_zero(at.angle, at.tail);
    return (place & 2U) != 0 ? -value : value;
}

// The terms of tan(x) after x, for |x| <= 0.6744.
double tan_terms(double x, double tail)
{
    constexpr std::array kTerms = {
        3.33333333333334091986e-01, 1.33333333333201242699e-01, 5.39682539762260521377e-02,
        2.18694882948595424599e-02, 8.86323982359930005737e-03, 3.59207910759131235356e-03,
        1.45620945432529025516e-03, 5.88041240820264096874e-04, 2.46463134818469906812e-04,
        7.81794442939557092300e-05, 7.14072491382608190305e-05, -1.85586374855275456654e-05,
        2.59073051863633712884e-05};
    const double z = x * x;
    double sum = 0;
    for (std::size_t k = kTerms.size(); k-- > 1;) {
        sum = kTerms[k] + z * sum;
    }
    return tail + z * (z * x * sum + tail) + z * x * kTerms[0];
}

// The tangent within pi/4, or -1 over it.
double tan_near_zero(double x, double tail, bool inverse)
{
    constexpr double kNear = 0.6744;
    constexpr double kQuarterTurnRest = 3.06161699786838301793e-17;
    const double sign = x < 0 ? -1 : 1;
    if (std::fabs(x) >= kNear) {  // tan(pi/4 - y) = 1 - 2 tan(y) / (1 + tan(y))
        const double y = (kQuarterTurn - sign * x) + (kQuarterTurnRest - sign * tail);
        const double terms = tan_terms(y, 0);
        const double w = y + terms;
        const double one = inverse ? -1 : 1;
        return sign * (one - 2 * (y + (terms - w * w / (w + one))));
    }
    const double terms = tan_terms(x, tail);
    const double w = x + terms;
    if (!inverse) {
        return w;
    }
    // -1 / (x + terms) from parts whose products are exact
    const double high = upper_half(w);
    const double low = terms - (high - x);
    const double quotient = -1 / w;
    const double part = upper_half(quotient);
    return part + quotient * (1 + part * high + part * low);
}

}  // namespace

double sin(double angle) { return sin_of(reduced(angle), 0); }

double cos(double angle) { return sin_of(reduced(angle), 1); }

double tan(double angle)
{
    const Reduced at = reduced(angle);
    return tan_near_zero(at.angle, at.tail, (at.quarters & 1U) != 0);
}

double cbrt(double value)
{
    if (value == 0 || !std::isfinite(value)) {
        return value;
    }
    // value = mantissa 8^thirds, mantissa in [1/8, 1)
    int exponent = 0;
    double mantissa = std::frexp(value, &exponent);
    const int thirds = exponent > 0 ? (exponent + 2) / 3 : -(-exponent / 3);
    mantissa = std::ldexp(mantissa, exponent - 3 * thirds);
    // a parabola within 2 % of the root, two steps of Halley to 1e-16, the last from exact products
    const double size = std::fabs(mantissa);
    double root = 0.34 + size * (1.21 - 0.56 * size);
    for (int step = 0; step < 2; ++step) {
        const double cube = root * root * root;
        root *= (cube + 2 * size) / (2 * cube + size);
    }
    root = upper_half(root);
    const double square = root * root;
    const double quotient = size / square;
    root += root * ((quotient - root) / (root + root + quotient));
    return std::ldexp(mantissa < 0 ? -root : root, thirds);
}

double hypot_scaled(double x, double y)
{
    const double size = std::fmax(std::fabs(x), std::fabs(y));
    if (size == 0 || !std::isfinite(size)) {
        return std::isinf(x) || std::isinf(y) ? std::fabs(size) : x + y;
    }
    int exponent = 0;
    (void)std::frexp(size, &exponent);
    x = std::ldexp(x, -exponent);
    y = std::ldexp(y, -exponent);
    return std::ldexp(std::sqrt(x * x + y * y), exponent);
}

double power_of_ten(int exponent)
{
    double power = 1;  // whole, and exact up to 10^22
    for (int k = 0; k < (exponent < 0 ? -exponent : exponent); ++k) {
        power *= 10;
    }
    return exponent < 0 ? 1 / power : power;
}

}  // namespace cusp::elementary
