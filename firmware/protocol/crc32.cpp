// CRC-32 with a table of 16: a nibble at a time costs little flash and a dozen instructions.
#include "firmware/protocol/crc32.hpp"

#include <array>

namespace cusp::protocol {
namespace {

constexpr std::array<std::uint32_t, 16> make_table() noexcept
{
    constexpr std::uint32_t kReflectedPolynomial = 0xEDB88320U;
    std::array<std::uint32_t, 16> table{};
    for (std::uint32_t nibble = 0; nibble < 16; ++nibble) {
        std::uint32_t remainder = nibble;
        for (int bit = 0; bit < 4; ++bit) {
            remainder = (remainder >> 1U) ^ ((remainder & 1U) != 0 ? kReflectedPolynomial : 0U);
        }
        table[nibble] = remainder;
    }
    return table;
}

constexpr std::array<std::uint32_t, 16> kTable = make_table();

}  // namespace

void Crc32::add(std::uint8_t byte) noexcept
{
    remainder_ ^= byte;
    remainder_ = (remainder_ >> 4U) ^ kTable[remainder_ & 15U];
    remainder_ = (remainder_ >> 4U) ^ kTable[remainder_ & 15U];
}

void Crc32::add(Span<const std::uint8_t> bytes) noexcept
{
    for (const std::uint8_t byte : bytes) {
        add(byte);
    }
}

}  // namespace cusp::protocol
