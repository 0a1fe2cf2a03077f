// LaneVec: three numbers in one register, on processors that have registers of four.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "firmware/base/vec.hpp"

namespace cusp {

// A Vec3f by lanes: the same operations and so the same bits. The fourth lane is not looked at.
struct WideVec {
    using Floats = float __attribute__((vector_size(16)));
    using Integers = std::int32_t __attribute__((vector_size(16)));

    Floats lanes;

    friend WideVec operator+(WideVec a, WideVec b) noexcept { return {a.lanes + b.lanes}; }
    friend WideVec operator-(WideVec a, WideVec b) noexcept { return {a.lanes - b.lanes}; }
    friend WideVec operator*(WideVec a, float k) noexcept { return {a.lanes * k}; }
    friend WideVec operator/(WideVec a, float k) noexcept { return {a.lanes / k}; }
};

inline float dot(WideVec a, WideVec b) noexcept
{
    const WideVec::Floats products = a.lanes * b.lanes;
    return products[0] + products[1] + products[2];
}

// The sum of the three numbers.
inline float sum(WideVec a) noexcept { return a.lanes[0] + a.lanes[1] + a.lanes[2]; }
inline float sum(Vec3f a) noexcept { return a.x + a.y + a.z; }

inline float norm(WideVec a) noexcept { return std::sqrt(dot(a, a)); }

inline WideVec magnitude(WideVec a) noexcept
{
    WideVec::Integers bits;
    static_assert(sizeof(bits) == sizeof(a.lanes));
    __builtin_memcpy(&bits, &a.lanes, sizeof(bits));
    bits &= 0x7FFFFFFF;
    __builtin_memcpy(&a.lanes, &bits, sizeof(bits));
    return a;
}

inline WideVec larger(WideVec a, WideVec b) noexcept
{
    return {a.lanes < b.lanes ? b.lanes : a.lanes};
}

inline WideVec smaller(WideVec a, WideVec b) noexcept
{
    return {b.lanes < a.lanes ? b.lanes : a.lanes};
}

// Lane by lane.
inline WideVec product(WideVec a, WideVec b) noexcept { return {a.lanes * b.lanes}; }
inline WideVec quotient(WideVec a, WideVec b) noexcept { return {a.lanes / b.lanes}; }

inline Vec3f larger(Vec3f a, Vec3f b) noexcept
{
    return {a.x < b.x ? b.x : a.x, a.y < b.y ? b.y : a.y, a.z < b.z ? b.z : a.z};
}

inline Vec3f smaller(Vec3f a, Vec3f b) noexcept
{
    return {b.x < a.x ? b.x : a.x, b.y < a.y ? b.y : a.y, b.z < a.z ? b.z : a.z};
}
inline Vec3f product(Vec3f a, Vec3f b) noexcept { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3f quotient(Vec3f a, Vec3f b) noexcept { return {a.x / b.x, a.y / b.y, a.z / b.z}; }

// The least of a number and the three of a vector.
inline float least(float most, float x, float y, float z) noexcept
{
    most = x < most ? x : most;
    most = y < most ? y : most;
    return z < most ? z : most;
}
inline float least(float most, WideVec a) noexcept
{
    return least(most, a.lanes[0], a.lanes[1], a.lanes[2]);
}
inline float least(float most, Vec3f a) noexcept { return least(most, a.x, a.y, a.z); }

// The greatest of a number and the three of a vector.
inline float greatest(float most, float x, float y, float z) noexcept
{
    most = most < x ? x : most;
    most = most < y ? y : most;
    return most < z ? z : most;
}
inline float greatest(float most, WideVec a) noexcept
{
    return greatest(most, a.lanes[0], a.lanes[1], a.lanes[2]);
}
inline float greatest(float most, Vec3f a) noexcept { return greatest(most, a.x, a.y, a.z); }

// Cores of 64 bits have such registers, or a compiler that does without.
using LaneVec = std::conditional_t<sizeof(std::size_t) == 8, WideVec, Vec3f>;

// One number in all lanes.
template <class Lane = LaneVec>
Lane all_lanes(float k) noexcept
{
    if constexpr (std::is_same_v<Lane, WideVec>) {
        return Lane{{k, k, k, k}};
    } else {
        return {k, k, k};
    }
}

template <class Lane = LaneVec>
Lane to_lanes(const Vec3f& a) noexcept
{
    if constexpr (std::is_same_v<Lane, WideVec>) {
        return Lane{{a.x, a.y, a.z, 0.0F}};
    } else {
        return a;
    }
}

// The difference of two places, scaled.
template <class Lane = LaneVec>
Lane scaled_difference(const Vec3<std::int32_t>& a,
                       const Vec3<std::int32_t>& b,
                       float scale) noexcept
{
    if constexpr (std::is_same_v<Lane, WideVec>) {
        const WideVec::Integers d =
            WideVec::Integers{a.x, a.y, a.z, 0} - WideVec::Integers{b.x, b.y, b.z, 0};
        return Lane{__builtin_convertvector(d, WideVec::Floats) * scale};
    } else {
        const Vec3<std::int32_t> d = a - b;
        return Vec3f{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)} *
               scale;
    }
}

inline Vec3f to_vec(const WideVec& a) noexcept { return {a.lanes[0], a.lanes[1], a.lanes[2]}; }
inline Vec3f to_vec(const Vec3f& a) noexcept { return a; }

}  // namespace cusp
