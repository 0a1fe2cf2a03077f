// LaserPower: the power that a laser has along a move, in 16 bits.
#pragma once

#include <cstdint>

namespace cusp::path {

// Either a spindle speed, or a spindle speed for each mm/s of the machine. Within 0.1 %: six bits of
// exponent and nine of mantissa, which is a float without what no laser needs.
class LaserPower {
public:
    // Off.
    constexpr LaserPower() noexcept = default;

    // speed: rpm of the S word; 0: off.
    static LaserPower constant(float speed) noexcept { return LaserPower{encode(speed)}; }
    // As much for each length of the path, whatever the machine's speed: `speed` at `feed`, mm/s, > 0.
    static LaserPower by_length(float speed, float feed) noexcept
    {
        const std::uint16_t code = encode(speed / feed);
        return LaserPower{static_cast<std::uint16_t>(code != 0 ? code | kByLength : 0U)};
    }

    bool on() const noexcept { return code_ != 0; }

    // rpm, while the machine moves at `velocity`, mm/s; 0 at rest.
    float at(float velocity) const noexcept
    {
        if (code_ == 0 || velocity <= 0) {
            return 0;
        }
        const std::uint32_t bits = ((code_ & ~unsigned{kByLength}) + kLeast) << kDropped;
        float value = 0;
        __builtin_memcpy(&value, &bits, sizeof value);
        return (code_ & kByLength) != 0 ? value * velocity : value;
    }

    friend constexpr bool operator==(LaserPower a, LaserPower b) noexcept
    {
        return a.code_ == b.code_;
    }
    friend constexpr bool operator!=(LaserPower a, LaserPower b) noexcept { return !(a == b); }

private:
    constexpr explicit LaserPower(std::uint16_t code) noexcept : code_{code} {}

    static constexpr std::uint16_t kByLength = 1U << 15U;
    static constexpr unsigned kDropped = 14;  // bits of a float's mantissa
    // The least code is that of 2^-22, the greatest that of 2^42.
    static constexpr std::uint32_t kLeast = (127U - 22U) << 9U;

    static std::uint16_t encode(float value) noexcept
    {
        if (!(value > 0)) {
            return 0;
        }
        std::uint32_t bits = 0;
        __builtin_memcpy(&bits, &value, sizeof bits);
        const std::uint32_t rounded = (bits + (1U << (kDropped - 1))) >> kDropped;
        constexpr std::uint32_t kMost = kByLength - 1U;
        const std::uint32_t code = rounded > kLeast ? rounded - kLeast : 1U;
        return static_cast<std::uint16_t>(code < kMost ? code : kMost);
    }

    std::uint16_t code_{0};
};

}  // namespace cusp::path
