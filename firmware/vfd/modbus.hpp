// Messages of Modbus RTU: bytes, and the checksum at their end (Modbus over Serial Line V1.02, section 2.5).
#pragma once

#include <cstdint>

#include "firmware/base/span.hpp"
#include "firmware/base/static_vector.hpp"

namespace cusp::vfd {

// As long as any that is sent or understood here.
inline constexpr std::size_t kMessageSize = 9;
using Message = StaticVector<std::uint8_t, kMessageSize>;

// Polynomial x^16 + x^15 + x^2 + 1, the lowest bit of each byte first; the low byte is sent first.
std::uint16_t crc16(Span<const std::uint8_t> bytes) noexcept;

// Precondition: room for two more bytes.
void add_checksum(Message& message) noexcept;
// The last two bytes are the checksum of those before.
bool has_checksum(Span<const std::uint8_t> bytes) noexcept;

}  // namespace cusp::vfd
