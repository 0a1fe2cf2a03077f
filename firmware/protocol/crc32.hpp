// CRC-32 of IEEE 802.3, a byte at a time: guards checked lines and stored settings.
#pragma once

#include <cstdint>

#include "firmware/base/span.hpp"

namespace cusp::protocol {

// Start with Crc32{}, add() every byte, read value(). "123456789" gives 0xCBF43926.
class Crc32 {
public:
    void add(std::uint8_t byte) noexcept;
    void add(Span<const std::uint8_t> bytes) noexcept;
    std::uint32_t value() const noexcept { return ~remainder_; }

private:
    std::uint32_t remainder_{0xFFFFFFFFU};
};

}  // namespace cusp::protocol
