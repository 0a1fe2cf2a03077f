// Arc functions: atan2 by fractions of the vector's coordinates, asin and acos by a quotient of polynomials.
//
// The polynomials are those of musl 1.2 and FreeBSD's msun (s_atan.c, e_asin.c): Copyright (C) 1993 by Sun Microsystems,
// Inc. All rights reserved. Permission to use, copy, modify, and distribute this software is freely granted, provided that
// this notice is preserved.
#include <array>
#include <cstddef>

#include "host_tools/base/elementary/double_bits.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::elementary {
namespace {

// pi/2 and pi with what their doubles lack.
constexpr double kRightAngle = 1.57079632679489655800e+00;
constexpr double kRightAngleRest = 6.12323399573676603587e-17;
constexpr double kHalfTurn = 2 * kRightAngle;
constexpr double kHalfTurnRest = 2 * kRightAngleRest;

// 1 - atan(t) / t, for |t| <= 7/16.
double atan_share(double t)
{
    constexpr std::array kTerms = {
        3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
        -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
        6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
        -3.65315727442169155270e-02, 1.62858201153657823623e-02};
    const double z = t * t;
    double sum = 0;
    for (std::size_t k = kTerms.size(); k-- > 0;) {
        sum = z * (kTerms[k] + sum);
    }
    return sum;
}

// The rounding error of the quotient: a / b less its rounded value.
double quotient_error(double a, double b, double quotient)
{
    constexpr double kLeast = 1e-140;
    constexpr double kGreatest = 1e140;  // no limit of lengths
    if (!(quotient > kLeast && b > kLeast && b < kGreatest)) {
        return 0;  // products of parts would be too small or too large, and the error does not matter
    }
    const double high = upper_half(quotient);
    const double b_high = upper_half(b);
    const double rest = b - b_high;
    return ((((a - high * b_high) - high * rest) - (quotient - high) * b_high) -
            (quotient - high) * rest) /
           b;
}

// The angle of a vector in the first quadrant in two parts; one of the numbers is above 0.
Sum angle_above(double y, double x)
{
    struct Turn {
        double sixteenths;  // of the tangent, up to which it is used
        double whole;       // of its own tangent, and the rest: products are exact
        double half;
        double angle;
        double rest;
    };
    constexpr std::array<Turn, 3> kTurns = {{
        {11, 0, 0.5, 4.63647609000806093515e-01, 2.26987774529616870924e-17},
        {19, 1, 0, 7.85398163397448278999e-01, 3.06161699786838301793e-17},
        {39, 1, 0.5, 9.82793723247329054082e-01, 1.39033110312309984516e-17},
    }};
    if (16 * y < 7 * x) {
        const double t = y / x;
        return sum_of(t, quotient_error(y, x, t) - t * atan_share(t));
    }
    for (const Turn& turn : kTurns) {
        if (16 * y < turn.sixteenths * x) {
            const double t =
                ((y - turn.whole * x) - turn.half * x) / (x + (turn.whole + turn.half) * y);
            return sum_of(turn.angle, t - (t * atan_share(t) - turn.rest));
        }
    }
    const double t = x / y;
    return sum_of(kRightAngle,
                  -(t - (t * atan_share(t) + kRightAngleRest - quotient_error(x, y, t))));
}

// asin(x) = x + x asin_share(x^2), for |x| <= 1/2.
double asin_share(double z)
{
    const double p =
        z * (1.66666666666666657415e-01 +
             z * (-3.25565818622400915405e-01 +
                  z * (2.01212532134862925881e-01 +
                       z * (-4.00555345006794114027e-02 +
                            z * (7.91534994289814532176e-04 + z * 3.47933107596021167570e-05)))));
    const double q =
        1.0 + z * (-2.40339491173441421878e+00 +
                   z * (2.02094576023350569471e+00 +
                        z * (-6.88283971605453293030e-01 + z * 7.70381505559019352791e-02)));
    return p / q;
}

// The square root of z in two parts.
Sum root_of(double z)
{
    const double root = std::sqrt(z);
    const double high = upper_half(root);
    return {high, root > 0 ? (z - high * high) / (root + high) : 0};
}

}  // namespace

double asin(double sine)
{
    const double size = std::fabs(sine);
    if (size < 0.5) {
        return sine + sine * asin_share(sine * sine);
    }
    // asin(x) = pi/2 - 2 asin(sqrt((1 - x) / 2))
    const double z = (1 - size) * 0.5;
    const double root = std::sqrt(z);
    const Sum parts = root_of(z);
    const double half = 0.5 * kRightAngle;
    const double angle = half - ((2 * root * asin_share(z) - (kRightAngleRest - 2 * parts.error)) -
                                 (half - 2 * parts.value));
    return sine < 0 ? -angle : angle;
}

double acos(double cosine)
{
    if (std::fabs(cosine) < 0.5) {
        return kRightAngle - (cosine - (kRightAngleRest - cosine * asin_share(cosine * cosine)));
    }
    const double z = (1 - std::fabs(cosine)) * 0.5;
    const double share = asin_share(z) * std::sqrt(z);
    if (cosine < 0) {
        return 2 * (kRightAngle - (std::sqrt(z) + (share - kRightAngleRest)));
    }
    const Sum parts = root_of(z);
    return 2 * (parts.value + (share + parts.error));
}

double atan(double tangent) { return atan2(tangent, 1); }

double atan2(double y, double x)
{
    if (std::isnan(x) || std::isnan(y)) {
        return x + y;
    }
    double across = std::fabs(y);
    double along = std::fabs(x);
    if (std::isinf(across) || std::isinf(along)) {
        across = std::isinf(across) ? 1 : 0;
        along = std::isinf(along) ? 1 : 0;
    }
    constexpr double kLarge = 0x1p1000;
    constexpr double kSmaller = 0x1p-100;
    if (across > kLarge || along > kLarge) {
        across *= kSmaller;
        along *= kSmaller;
    }
    Sum angle = across == 0 ? Sum{0, 0} : angle_above(across, along);
    if (std::signbit(x)) {
        const Sum turned = sum_of(kHalfTurn, -angle.value);
        angle = {turned.value, turned.error + (kHalfTurnRest - angle.error)};
    }
    const double size = angle.value + angle.error;
    return std::signbit(y) ? -size : size;
}

}  // namespace cusp::elementary
