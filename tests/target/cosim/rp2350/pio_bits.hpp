// Words of bits, as a state machine shifts and maps them.
#pragma once

#include <cstdint>

namespace cusp::cosim::rp2350 {

inline constexpr unsigned kWord = 32;

inline std::uint32_t low_bits(unsigned count) { return count >= kWord ? ~0U : (1U << count) - 1U; }

inline std::uint32_t rotated_left(std::uint32_t value, unsigned by)
{
    return by == 0 ? value : value << by | value >> (kWord - by);
}

}  // namespace cusp::cosim::rp2350
