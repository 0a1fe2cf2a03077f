// Vectors of three numbers, and the exact position. Lengths are millimetres unless a name says nm.
//
//   Position tail = to_position({10.0, 0.0, -2.5});     // whole nanometres: sums stay exact
//   double length = norm(to_millimetres(end - tail));   // double where geometry is prepared
//   Vec3f local = to_float(to_millimetres(end - tail)); // float in the servo tick, from the
//                                                       // block's start
//
// `base` holds the words that all modules share, one idea a header: vectors, axes (axis.hpp),
// results (result.hpp), errors (error.hpp), pulse frames (pulse_frame.hpp), containers of fixed size.
#pragma once

#include <cmath>
#include <cstdint>

namespace cusp {

template <class T>
struct Vec3 {
    T x{};
    T y{};
    T z{};

    constexpr T& operator[](unsigned axis) noexcept { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr const T& operator[](unsigned axis) const noexcept
    {
        return axis == 0 ? x : axis == 1 ? y : z;
    }

    constexpr Vec3 operator-() const noexcept { return {-x, -y, -z}; }
    friend constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept
    {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept
    {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator*(Vec3 a, T k) noexcept { return {a.x * k, a.y * k, a.z * k}; }
    friend constexpr Vec3 operator*(T k, Vec3 a) noexcept { return a * k; }
    friend constexpr Vec3 operator/(Vec3 a, T k) noexcept { return {a.x / k, a.y / k, a.z / k}; }
    friend constexpr bool operator==(Vec3 a, Vec3 b) noexcept
    {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
    friend constexpr bool operator!=(Vec3 a, Vec3 b) noexcept { return !(a == b); }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

// A place of the machine, exact: whole nanometres, machine coordinates.
using Position = Vec3<std::int64_t>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) noexcept
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) noexcept
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
T norm(Vec3<T> a) noexcept
{
    return std::sqrt(dot(a, a));
}

// Each part without its sign.
inline Vec3f magnitude(Vec3f a) noexcept
{
    return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)};
}

constexpr Vec3f to_float(Vec3d a) noexcept
{
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

inline constexpr double kNanometresPerMillimetre = 1e6;

// Nearest doubles: exact for the micrometre grid of machine travel, within 1e-10 mm to 1000 m.
constexpr Vec3d to_millimetres(Position p) noexcept
{
    return {static_cast<double>(p.x) / kNanometresPerMillimetre,
            static_cast<double>(p.y) / kNanometresPerMillimetre,
            static_cast<double>(p.z) / kNanometresPerMillimetre};
}

// To the nearest nanometre, halves away from zero. Precondition: |mm| < 9e12.
constexpr std::int64_t to_nanometres(double mm) noexcept
{
    const double nm = mm * kNanometresPerMillimetre;
    return static_cast<std::int64_t>(nm < 0 ? nm - 0.5 : nm + 0.5);
}

constexpr Position to_position(Vec3d mm) noexcept
{
    return {to_nanometres(mm.x), to_nanometres(mm.y), to_nanometres(mm.z)};
}

}  // namespace cusp
