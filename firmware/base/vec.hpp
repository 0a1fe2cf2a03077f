// Vectors, and the exact position. Lengths are millimetres unless a name says nm.
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
#include <type_traits>

#include "firmware/base/axis.hpp"

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

// Places and directions with the rotary axis: a degree counts as a millimetre.
template <class T>
struct Vec4 {
    T x{};
    T y{};
    T z{};
    T a{};

    constexpr Vec4() noexcept = default;
    constexpr Vec4(T x_, T y_, T z_, T a_ = {}) noexcept : x{x_}, y{y_}, z{z_}, a{a_} {}
    // The rotary axis stands at 0.
    constexpr Vec4(Vec3<T> v) noexcept : x{v.x}, y{v.y}, z{v.z} {}

    constexpr T& operator[](unsigned axis) noexcept
    {
        return axis == 0 ? x : axis == 1 ? y : axis == 2 ? z : a;
    }
    constexpr const T& operator[](unsigned axis) const noexcept
    {
        return axis == 0 ? x : axis == 1 ? y : axis == 2 ? z : a;
    }

    constexpr Vec4 operator-() const noexcept { return {-x, -y, -z, -a}; }
    friend constexpr Vec4 operator+(Vec4 b, Vec4 c) noexcept
    {
        return {b.x + c.x, b.y + c.y, b.z + c.z, b.a + c.a};
    }
    friend constexpr Vec4 operator-(Vec4 b, Vec4 c) noexcept
    {
        return {b.x - c.x, b.y - c.y, b.z - c.z, b.a - c.a};
    }
    friend constexpr Vec4 operator*(Vec4 b, T k) noexcept
    {
        return {b.x * k, b.y * k, b.z * k, b.a * k};
    }
    friend constexpr Vec4 operator*(T k, Vec4 b) noexcept { return b * k; }
    friend constexpr Vec4 operator/(Vec4 b, T k) noexcept
    {
        return {b.x / k, b.y / k, b.z / k, b.a / k};
    }
    friend constexpr bool operator==(Vec4 b, Vec4 c) noexcept
    {
        return b.x == c.x && b.y == c.y && b.z == c.z && b.a == c.a;
    }
    friend constexpr bool operator!=(Vec4 b, Vec4 c) noexcept { return !(b == c); }
};

// A number for each axis that this build has.
template <class T>
using AxisVec = std::conditional_t<kAxisCount == 3, Vec3<T>, Vec4<T>>;

using AxisVecf = AxisVec<float>;
using AxisVecd = AxisVec<double>;

// A place of the machine, exact: whole nanometres, machine coordinates; the rotary axis has millionths of a
// degree.
using Position = AxisVec<std::int64_t>;

// The same without the rotary axis.
template <class T>
constexpr Vec3<T> xyz(Vec3<T> a) noexcept
{
    return a;
}
template <class T>
constexpr Vec3<T> xyz(Vec4<T> a) noexcept
{
    return {a.x, a.y, a.z};
}

// A vector of the numbers that `f` makes of those of another.
template <class T, class F>
constexpr auto mapped(const Vec3<T>& v, F f) noexcept -> Vec3<decltype(f(v.x))>
{
    return {f(v.x), f(v.y), f(v.z)};
}
template <class T, class F>
constexpr auto mapped(const Vec4<T>& v, F f) noexcept -> Vec4<decltype(f(v.x))>
{
    return {f(v.x), f(v.y), f(v.z), f(v.a)};
}

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) noexcept
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr T dot(Vec4<T> b, Vec4<T> c) noexcept
{
    return b.x * c.x + b.y * c.y + b.z * c.z + b.a * c.a;
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
template <class T>
T norm(Vec4<T> a) noexcept
{
    return std::sqrt(dot(a, a));
}

// Each part without its sign.
inline AxisVecf magnitude(AxisVecf v) noexcept
{
    return mapped(v, [](float part) { return std::fabs(part); });
}

template <class T>
constexpr Vec3f to_float(Vec3<T> v) noexcept
{
    return mapped(v, [](T part) { return static_cast<float>(part); });
}
template <class T>
constexpr Vec4<float> to_float(Vec4<T> v) noexcept
{
    return mapped(v, [](T part) { return static_cast<float>(part); });
}
constexpr AxisVecd to_double(AxisVecf v) noexcept
{
    return mapped(v, [](float part) { return static_cast<double>(part); });
}

inline constexpr double kNanometresPerMillimetre = 1e6;

// Nearest doubles: exact for the micrometre grid of machine travel, within 1e-10 mm to 1000 m.
constexpr AxisVecd to_millimetres(Position p) noexcept
{
    return mapped(
        p, [](std::int64_t nm) { return static_cast<double>(nm) / kNanometresPerMillimetre; });
}

// To the nearest nanometre, halves away from zero. Precondition: |mm| < 9e12.
constexpr std::int64_t to_nanometres(double mm) noexcept
{
    const double nm = mm * kNanometresPerMillimetre;
    return static_cast<std::int64_t>(nm < 0 ? nm - 0.5 : nm + 0.5);
}

constexpr Position to_position(AxisVecd mm) noexcept { return mapped(mm, to_nanometres); }

}  // namespace cusp
