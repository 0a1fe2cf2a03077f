// The few functions of analysis that firmware needs, with the same bits on every host and target.
// The C library's differ from one to the next; only sqrt, fabs and floor are the same everywhere.
#pragma once

namespace cusp {

inline constexpr double kPi = 3.14159265358979323846;

template <class T>
struct SinCos {
    T sin;
    T cos;
};

// Sine and cosine of an angle in radians. Precondition: |angle| <= 1e4.
// Accuracy: absolute error at most 1e-15 (double, |angle| <= 100) and 1.2e-7 (float, |angle| <= 8).
SinCos<double> sin_cos(double angle) noexcept;
SinCos<float> sin_cos(float angle) noexcept;

// The nearest multiple of a quarter turn to an angle in radians, in quarter turns, plus a half.
inline float quarter_turns(float angle) noexcept { return angle * 0.636619772F + 0.5F; }

// As sin_cos(), the same bits, where quarter_turns() is in [0, 1): within pi/4 of 0.
inline SinCos<float> sin_cos_near_zero(float x) noexcept
{
    const float z = x * x;
    const float sine =
        x + x * z * (((2.7557319e-6F * z - 1.9841270e-4F) * z + 8.3333333e-3F) * z - 1.6666667e-1F);
    const float cosine =
        1.0F - z * (0.5F - z * ((2.4801587e-5F * z - 1.3888889e-3F) * z + 4.1666667e-2F));
    return {sine, cosine};
}

// The angle of the vector (x, y) in (-pi, pi]; 0 for (0, 0). Absolute error at most 5e-16.
double atan2(double y, double x) noexcept;

// Cube root, relative error at most 1e-6. Precondition: 1e-18 <= q <= 1e18.
float cube_root(float q) noexcept;

}  // namespace cusp
