// Checksums of messages.
#include "firmware/vfd/modbus.hpp"

namespace cusp::vfd {

std::uint16_t crc16(Span<const std::uint8_t> bytes) noexcept
{
    constexpr unsigned kPolynomial = 0xA001;  // reflected
    unsigned crc = 0xFFFF;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (unsigned bit = 0; bit < 8; ++bit) {
            crc = (crc & 1U) != 0 ? crc >> 1U ^ kPolynomial : crc >> 1U;
        }
    }
    return static_cast<std::uint16_t>(crc);
}

void add_checksum(Message& message) noexcept
{
    const unsigned crc = crc16(message.span());
    (void)message.try_push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    (void)message.try_push_back(static_cast<std::uint8_t>(crc >> 8U));
}

bool has_checksum(Span<const std::uint8_t> bytes) noexcept
{
    constexpr std::size_t kChecksum = 2;
    if (bytes.size() <= kChecksum) {
        return false;
    }
    const std::size_t size = bytes.size() - kChecksum;
    const unsigned crc = crc16(bytes.first(size));
    return bytes[size] == (crc & 0xFFU) && bytes[size + 1] == crc >> 8U;
}

}  // namespace cusp::vfd
