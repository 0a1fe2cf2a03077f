// LaneVec: a number for each axis in one register, on processors that have registers of four.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "firmware/base/vec.hpp"

namespace cusp {

// An AxisVecf by lanes: the same operations and so the same bits. Without a rotary axis the fourth lane is
// not looked at.
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
    const float linear = products[0] + products[1] + products[2];
    return kHasRotaryAxis ? linear + products[3] : linear;
}

// The sum of the numbers.
inline float sum(WideVec a) noexcept
{
    const float linear = a.lanes[0] + a.lanes[1] + a.lanes[2];
    return kHasRotaryAxis ? linear + a.lanes[3] : linear;
}
inline float sum(const Vec3f& v) noexcept { return v.x + v.y + v.z; }
inline float sum(const Vec4<float>& v) noexcept { return v.x + v.y + v.z + v.a; }

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

// A function of two numbers, axis by axis.
template <class F>
constexpr Vec3f merged(const Vec3f& v, const Vec3f& w, F f) noexcept
{
    return {f(v.x, w.x), f(v.y, w.y), f(v.z, w.z)};
}
template <class F>
constexpr Vec4<float> merged(const Vec4<float>& v, const Vec4<float>& w, F f) noexcept
{
    return {f(v.x, w.x), f(v.y, w.y), f(v.z, w.z), f(v.a, w.a)};
}
inline AxisVecf larger(AxisVecf v, AxisVecf w) noexcept
{
    return merged(v, w, [](float a, float b) { return a < b ? b : a; });
}
inline AxisVecf smaller(AxisVecf v, AxisVecf w) noexcept
{
    return merged(v, w, [](float a, float b) { return b < a ? b : a; });
}
inline AxisVecf product(AxisVecf v, AxisVecf w) noexcept
{
    return merged(v, w, [](float a, float b) { return a * b; });
}
inline AxisVecf quotient(AxisVecf v, AxisVecf w) noexcept
{
    return merged(v, w, [](float a, float b) { return a / b; });
}

// The least of a number and those of a vector.
inline float least(float most, const Vec3f& v) noexcept
{
    most = v.x < most ? v.x : most;
    most = v.y < most ? v.y : most;
    return v.z < most ? v.z : most;
}
inline float least(float most, const Vec4<float>& v) noexcept
{
    most = least(most, xyz(v));
    return v.a < most ? v.a : most;
}

// The greatest of a number and those of a vector.
inline float greatest(float most, const Vec3f& v) noexcept
{
    most = most < v.x ? v.x : most;
    most = most < v.y ? v.y : most;
    return most < v.z ? v.z : most;
}
inline float greatest(float most, const Vec4<float>& v) noexcept
{
    most = greatest(most, xyz(v));
    return most < v.a ? v.a : most;
}

inline void take_lanes(const WideVec& from, Vec3f& v) noexcept
{
    v = {from.lanes[0], from.lanes[1], from.lanes[2]};
}
inline void take_lanes(const WideVec& from, Vec4<float>& v) noexcept
{
    v = {from.lanes[0], from.lanes[1], from.lanes[2], from.lanes[3]};
}
inline AxisVecf to_vec(const WideVec& v) noexcept
{
    AxisVecf vec{};
    take_lanes(v, vec);
    return vec;
}
inline AxisVecf to_vec(const AxisVecf& v) noexcept { return v; }

inline float least(float most, WideVec v) noexcept { return least(most, to_vec(v)); }
inline float greatest(float most, WideVec v) noexcept { return greatest(most, to_vec(v)); }

// Cores of 64 bits have such registers, or a compiler that does without.
using LaneVec = std::conditional_t<sizeof(std::size_t) == 8, WideVec, AxisVecf>;

// One number in all lanes.
template <class Lane = LaneVec>
Lane all_lanes(float k) noexcept
{
    if constexpr (std::is_same_v<Lane, WideVec>) {
        return Lane{{k, k, k, k}};
    } else {
        return mapped(Lane{}, [k](float) { return k; });
    }
}

// The numbers of a vector in lanes. The lane of an axis that is not is 0.
inline WideVec::Floats in_lanes(const Vec3f& v) noexcept
{
    return WideVec::Floats{v.x, v.y, v.z, 0.0F};
}
inline WideVec::Floats in_lanes(const Vec4<float>& v) noexcept
{
    return WideVec::Floats{v.x, v.y, v.z, v.a};
}
inline WideVec::Integers in_lanes(const Vec3<std::int32_t>& v) noexcept
{
    return WideVec::Integers{v.x, v.y, v.z, 0};
}
inline WideVec::Integers in_lanes(const Vec4<std::int32_t>& v) noexcept
{
    return WideVec::Integers{v.x, v.y, v.z, v.a};
}

template <class Lane = LaneVec>
Lane to_lanes(const AxisVecf& v) noexcept
{
    if constexpr (std::is_same_v<Lane, WideVec>) {
        return Lane{in_lanes(v)};
    } else {
        return v;
    }
}

// The difference of two places, scaled.
template <class Lane = LaneVec>
Lane scaled_difference(const AxisVec<std::int32_t>& v,
                       const AxisVec<std::int32_t>& w,
                       float scale) noexcept
{
    if constexpr (std::is_same_v<Lane, WideVec>) {
        const WideVec::Integers d = in_lanes(v) - in_lanes(w);
        return Lane{__builtin_convertvector(d, WideVec::Floats) * scale};
    } else {
        return to_float(v - w) * scale;
    }
}

}  // namespace cusp
