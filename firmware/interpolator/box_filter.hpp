// Moving averages in exact integers: what goes in comes out to the last unit, spread over n ticks.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/assert.hpp"

namespace cusp::interpolator {

// Sum of the last n values, integers or vectors of them. The caller divides, or passes the sum on
// to the next filter.
template <class Value, std::uint32_t kMost>
class RunningSum {
public:
    // Precondition: 1 <= n <= kMost, drained().
    void set_length(std::uint32_t n) noexcept
    {
        CUSP_ASSERT(n >= 1 && n <= kMost);
        length_ = n;
        next_ = 0;
    }
    std::uint32_t length() const noexcept { return length_; }

    // Adds a value, forgets the one n calls ago, and returns the new sum.
    Value add(Value value) noexcept
    {
        const std::uint32_t place = next_;
        const std::uint32_t length = length_;
        const Value sum = sum_ + (value - values_[place]);
        sum_ = sum;
        values_[place] = value;
        next_ = place + 1 == length ? 0 : place + 1;
        filled_ = value == Value{} ? filled_ - (filled_ > 0 ? 1U : 0U) : length;
        return sum;
    }

    // The value added n calls ago.
    Value oldest() const noexcept { return values_[next_]; }

    // Ticks until drained, if only zeros follow.
    std::uint32_t ticks_left() const noexcept { return filled_; }

    // True if all n values are 0.
    bool drained() const noexcept { return filled_ == 0; }

    void clear() noexcept
    {
        values_.fill(Value{});
        sum_ = Value{};
        filled_ = 0;
    }

private:
    std::array<Value, kMost> values_{};
    std::uint32_t length_{1};
    std::uint32_t next_{0};
    std::uint32_t filled_{0};
    Value sum_{};
};

// Quotient that keeps its remainder for the next call, so that nothing is lost. Rounds down.
class ExactDivision {
public:
    // Precondition: divisor > 0.
    void set(std::int32_t divisor, std::int32_t remainder) noexcept
    {
        divisor_ = divisor;
        remainder_ = remainder;
    }

    std::int32_t divide(std::int32_t dividend) noexcept
    {
        const std::int32_t whole = dividend + remainder_;
        std::int32_t quotient = whole / divisor_;
        remainder_ = whole - quotient * divisor_;
        if (remainder_ < 0) {
            remainder_ += divisor_;
            --quotient;
        }
        return quotient;
    }

private:
    std::int32_t divisor_{1};
    std::int32_t remainder_{0};
};

}  // namespace cusp::interpolator
