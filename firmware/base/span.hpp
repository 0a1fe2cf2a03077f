// Span<T>: a view of a run of objects; the part of std::span that we use, until C++20.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/base/assert.hpp"

namespace cusp {

template <class T>
class Span {
public:
    constexpr Span() = default;
    constexpr Span(T* data, std::size_t size) noexcept : data_{data}, size_{size} {}
    // NOLINTBEGIN(google-explicit-constructor): as std::span converts.
    template <std::size_t N>
    constexpr Span(T (&array)[N]) noexcept : data_{array}, size_{N}
    {
    }
    template <class U, std::size_t N>
    constexpr Span(std::array<U, N>& array) noexcept : data_{array.data()}, size_{N}
    {
    }
    template <class U, std::size_t N>
    constexpr Span(const std::array<U, N>& array) noexcept : data_{array.data()}, size_{N}
    {
    }
    // NOLINTEND(google-explicit-constructor)

    constexpr T* data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr T* begin() const noexcept { return data_; }
    constexpr T* end() const noexcept { return data_ + size_; }

    // Precondition: index < size().
    constexpr T& operator[](std::size_t index) const noexcept
    {
        CUSP_ASSERT(index < size_);
        return data_[index];
    }

    // Precondition: count <= size().
    constexpr Span first(std::size_t count) const noexcept
    {
        CUSP_ASSERT(count <= size_);
        return {data_, count};
    }

private:
    T* data_{nullptr};
    std::size_t size_{0};
};

}  // namespace cusp
