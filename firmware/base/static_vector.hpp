// StaticVector<T, N>: a vector of at most N elements that never allocates.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/base/assert.hpp"
#include "firmware/base/span.hpp"

namespace cusp {

template <class T, std::size_t N>
class StaticVector {
public:
    static constexpr std::size_t capacity() noexcept { return N; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr bool full() const noexcept { return size_ == N; }
    constexpr void clear() noexcept { size_ = 0; }

    // False, and nothing added, where it is full.
    constexpr bool try_push_back(const T& value) noexcept
    {
        if (full()) {
            return false;
        }
        elements_[size_] = value;
        ++size_;
        return true;
    }
    // Takes in elements that have been written in place beyond the last.
    // Precondition: size() <= count <= capacity().
    constexpr void grow(std::size_t count) noexcept
    {
        CUSP_ASSERT(count >= size_ && count <= N);
        size_ = count;
    }
    // Keeps the first `count` elements. Precondition: count <= size().
    constexpr void shrink(std::size_t count) noexcept
    {
        CUSP_ASSERT(count <= size_);
        size_ = static_cast<decltype(size_)>(count);
    }
    // Precondition: !empty().
    constexpr void pop_back() noexcept
    {
        CUSP_ASSERT(size_ > 0);
        --size_;
    }

    // Precondition: index < size().
    constexpr T& operator[](std::size_t index) noexcept
    {
        CUSP_ASSERT(index < size_);
        return elements_[index];
    }
    constexpr const T& operator[](std::size_t index) const noexcept
    {
        CUSP_ASSERT(index < size_);
        return elements_[index];
    }
    constexpr T& back() noexcept { return (*this)[size_ - 1]; }
    constexpr const T& back() const noexcept { return (*this)[size_ - 1]; }

    constexpr T* begin() noexcept { return elements_.data(); }
    constexpr T* end() noexcept { return elements_.data() + size_; }
    constexpr const T* begin() const noexcept { return elements_.data(); }
    constexpr const T* end() const noexcept { return elements_.data() + size_; }
    constexpr Span<const T> span() const noexcept { return {elements_.data(), size_}; }

private:
    std::array<T, N> elements_{};
    std::size_t size_{0};
};

}  // namespace cusp
