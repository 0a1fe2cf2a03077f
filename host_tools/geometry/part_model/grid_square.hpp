// The squares of a grid in plan: their numbers, and one key for both.
#pragma once

#include <cstdint>

namespace cusp::part_model {

// Key of the square (i, j) for a hash table; distinct where both numbers fit 32 bits.
constexpr std::uint64_t square_key(std::int64_t i, std::int64_t j)
{
    return (static_cast<std::uint64_t>(i) << 32U) ^ (static_cast<std::uint64_t>(j) & 0xffffffffU);
}

}  // namespace cusp::part_model
