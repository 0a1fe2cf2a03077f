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

// The angle of the vector (x, y) in (-pi, pi]; 0 for (0, 0). Absolute error at most 5e-16.
double atan2(double y, double x) noexcept;

}  // namespace cusp
