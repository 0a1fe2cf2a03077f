// CRC-32, eight bytes at a time: a run has some 10^5 edges a second of its time, and firmware/protocol's, which saves
// flash, would take as long over them as the whole controller.
#include "host_tools/program_run/edge_checksum.hpp"

#include <array>

namespace cusp::program_run {
namespace {

// tables[k][b]: what byte b does to the remainder, k bytes later.
using SlicedTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr SlicedTables make_tables()
{
    constexpr std::uint32_t kReflectedPolynomial = 0xEDB88320U;
    SlicedTables tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t remainder = byte;
        for (int bit = 0; bit < 8; ++bit) {
            remainder = (remainder >> 1U) ^ ((remainder & 1U) != 0 ? kReflectedPolynomial : 0U);
        }
        tables[0][byte] = remainder;
    }
    for (std::size_t later = 1; later < tables.size(); ++later) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = tables[later - 1][byte];
            tables[later][byte] = (before >> 8U) ^ tables[0][before & 255U];
        }
    }
    return tables;
}

constexpr SlicedTables kTables = make_tables();

std::uint32_t after_byte(std::uint32_t remainder, std::uint32_t byte)
{
    return (remainder >> 8U) ^ kTables[0][(remainder ^ byte) & 255U];
}

}  // namespace

void EdgeChecksum::edge(std::uint64_t tick, unsigned wire, bool level)
{
    const auto low = static_cast<std::uint32_t>(tick) ^ remainder_;
    const auto high = static_cast<std::uint32_t>(tick >> 32U);
    const std::uint32_t after_tick = kTables[7][low & 255U] ^ kTables[6][low >> 8U & 255U] ^
                                     kTables[5][low >> 16U & 255U] ^ kTables[4][low >> 24U] ^
                                     kTables[3][high & 255U] ^ kTables[2][high >> 8U & 255U] ^
                                     kTables[1][high >> 16U & 255U] ^ kTables[0][high >> 24U];
    remainder_ = after_byte(after_byte(after_tick, wire), level ? 1U : 0U);
}

}  // namespace cusp::program_run
