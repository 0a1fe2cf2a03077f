// The functions of analysis that decide geometry, with the same bits on every machine.
//
//     const double turn = elementary::atan2(way.y, way.x);
//     const Vec2d ahead{elementary::cos(turn), elementary::sin(turn)};
//
// C libraries differ in the last bit of sin, cos, tan, asin, acos, atan2, cbrt and hypot, and one bit is enough for a
// planner to choose another of two equal ways. These here are sums, products, quotients and roots in double precision,
// which IEEE 754 rounds alike everywhere. The check `constants` refuses those of the library in host_tools; sqrt, floor,
// fabs, fmod, remainder, ldexp and frexp are exact, and are the library's.
//
// Errors are below 1 ulp of the result, that of hypot below 2^-52 of it (tests/unit/elementary). Arguments that are not numbers, or outside of the domain,
// give a NaN. The algorithms are those of musl and FreeBSD's msun (elementary.cpp).
#pragma once

#include <cmath>

namespace cusp::elementary {

// These take an angle in radians. Beyond 1.6e6 the angle is first reduced by the double next to 2 pi: the bits are the same
// everywhere, but they are those of an angle that is off by up to 4e-17 of itself.
double sin(double angle);
double cos(double angle);
double tan(double angle);

// Radians: asin and atan in [-pi/2, pi/2], acos in [0, pi].
double asin(double sine);
double acos(double cosine);
double atan(double tangent);
// The angle of the vector (x, y) in [-pi, pi]. Signs of zeros and infinite values as in IEEE 754: atan2(0, -1) is pi.
double atan2(double y, double x);

double cbrt(double value);

// As hypot(), where the sum of the squares is not between 1e-280 and 1e280.
double hypot_scaled(double x, double y);

// The length of the vector (x, y).
inline double hypot(double x, double y)
{
    constexpr double kLeast = 1e-280;
    constexpr double kGreatest = 1e280;  // no limit of lengths
    const double square = x * x + y * y;
    return square > kLeast && square < kGreatest ? std::sqrt(square) : hypot_scaled(x, y);
}

// 10^exponent, correctly rounded. exponent  -22 to 22
double power_of_ten(int exponent);

}  // namespace cusp::elementary
