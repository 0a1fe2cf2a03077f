// Result<T> and Status: a value, or the reason why there is none. Replaces exceptions in firmware.
#pragma once

#include <type_traits>

#include "firmware/base/assert.hpp"
#include "firmware/base/error.hpp"

namespace cusp {

template <class T>
class [[nodiscard]] Result {
    static_assert(std::is_trivially_copyable_v<T>, "a Result is passed by copy");

public:
    // NOLINTBEGIN(google-explicit-constructor): so that a function can return either as it is.
    constexpr Result(T value) : value_{value}, has_value_{true} {}
    constexpr Result(Error error) : error_{error} {}
    // NOLINTEND(google-explicit-constructor)

    constexpr explicit operator bool() const { return has_value_; }

    // Precondition: holds a value.
    constexpr const T& operator*() const
    {
        CUSP_ASSERT(has_value_);
        return value_;
    }
    constexpr const T* operator->() const { return &**this; }

    // Precondition: holds no value.
    constexpr Error error() const
    {
        CUSP_ASSERT(!has_value_);
        return error_;
    }

private:
    T value_{};
    Error error_{};
    bool has_value_{false};
};

// The outcome of an action without a value: done, or the reason why not.
struct Done {};
using Status = Result<Done>;
inline constexpr Done kDone{};

}  // namespace cusp
