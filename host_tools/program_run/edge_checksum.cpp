// CRC-32, ten bytes at a time: a run has some 10^5 edges for each second of machine time. The CRC of
// firmware/protocol, which saves flash, would take as long as the whole controller.
#include "host_tools/program_run/edge_checksum.hpp"

#include <array>

#include "firmware/base/axis.hpp"

namespace cusp::program_run {
namespace {

// tables[k][b]: the remainder of byte b followed by k bytes.
using SlicedTables = std::array<std::array<std::uint32_t, 256>, 10>;

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

// The remainder of the last two bytes of an edge, wire and level; index: 2 wire + level.
constexpr std::array<std::uint32_t, 4 * kAxisCount> make_ends()
{
    std::array<std::uint32_t, 4 * kAxisCount> ends{};
    for (std::uint32_t end = 0; end < ends.size(); ++end) {
        ends[end] = kTables[1][end >> 1U] ^ kTables[0][end & 1U];
    }
    return ends;
}

constexpr auto kEnds = make_ends();

}  // namespace

void EdgeChecksum::edge(std::uint64_t tick, unsigned wire, bool level)
{
    const auto high = static_cast<std::uint32_t>(tick >> 32U);
    if (high != high_) {
        high_ = high;
        after_high_ = kTables[5][high & 255U] ^ kTables[4][high >> 8U & 255U] ^
                      kTables[3][high >> 16U & 255U] ^ kTables[2][high >> 24U];
    }
    const auto low = static_cast<std::uint32_t>(tick) ^ remainder_;
    remainder_ = kTables[9][low & 255U] ^ kTables[8][low >> 8U & 255U] ^
                 kTables[7][low >> 16U & 255U] ^ kTables[6][low >> 24U] ^ after_high_ ^
                 kEnds[2 * wire + (level ? 1U : 0U)];
}

}  // namespace cusp::program_run
