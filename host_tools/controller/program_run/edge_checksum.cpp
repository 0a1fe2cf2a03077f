// CRC-32, four edges at a time: a run has some 10^5 edges for each second of machine time. The CRC of
// firmware/protocol, which saves flash, would take as long as the whole controller.
//
// An edge has ten bytes, of which the first four meet the remainder: with L the remainder of four
// bytes followed by six zeros, r' = L(r ^ tick) ^ end, where `end` is that of the other six bytes.
// L is linear, so a run of edges is a polynomial in it. Its digits do not depend on the remainder;
// four are taken at a time by the powers of L, so that one table look-up need not wait for another.
#include "host_tools/controller/program_run/edge_checksum.hpp"

#include "firmware/base/axis.hpp"

namespace cusp::program_run {
namespace {

// tables[k][b]: the remainder of byte b followed by k bytes.
constexpr std::size_t kBytesPerEdge = 10;
constexpr std::size_t kEdgesAtOnce = 4;
using SlicedTables = std::array<std::array<std::uint32_t, 256>, kBytesPerEdge * kEdgesAtOnce>;

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

// L applied kTimes: x is the first four bytes of an edge, followed by those of kTimes - 1 more.
template <std::size_t kTimes>
std::uint32_t power(std::uint32_t x)
{
    constexpr std::size_t kLast = kBytesPerEdge * kTimes - 1;
    return kTables[kLast][x & 255U] ^ kTables[kLast - 1][x >> 8U & 255U] ^
           kTables[kLast - 2][x >> 16U & 255U] ^ kTables[kLast - 3][x >> 24U];
}

// The remainder of the upper half of a tick, followed by two bytes.
std::uint32_t after_high(std::uint32_t high)
{
    return kTables[5][high & 255U] ^ kTables[4][high >> 8U & 255U] ^
           kTables[3][high >> 16U & 255U] ^ kTables[2][high >> 24U];
}

constexpr std::size_t kLineSets = 1U << std::size(EdgeChecksum::kLinesInOrder);

// The remainder of the last two bytes of a falling edge, wire and level, by the line's bit.
constexpr std::array<std::uint32_t, kLineSets> kFallOfLine = [] {
    std::array<std::uint32_t, kLineSets> ends{};
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        ends[step_line(axis)] = kTables[1][2 * axis] ^ kTables[0][0];
        ends[direction_line(axis)] = kTables[1][2 * axis + 1] ^ kTables[0][0];
    }
    return ends;
}();
constexpr std::uint32_t kRise = kTables[0][0] ^ kTables[0][1];  // what a rising edge has more

}  // namespace

void EdgeChecksum::frame_played(std::uint64_t start_tick, const PulseFrame& frame)
{
    // A frame in flight at the start does not belong to the trace.
    if (start_tick < start_) {
        return;
    }
    const std::uint64_t tick = start_tick - start_;
    const auto low = static_cast<std::uint32_t>(tick);
    const auto high = static_cast<std::uint32_t>(tick >> 32U);
    std::uint32_t upper = after_high(high);
    std::uint32_t end = 0;  // of the edge before
    std::uint32_t* out = digits_.data();
    unsigned levels = levels_;
    for (const PulseEdge& at : frame.edges) {
        const unsigned now = (levels | at.raise) & ~unsigned{at.lower};
        const unsigned changed = (now ^ levels) & traced_;
        levels = now;
        const std::uint32_t time = low + at.tick;
        if (time < low) {
            upper = after_high(high + 1);
        }
        const auto add = [&](unsigned line) {
            *out++ = end ^ time;
            end = upper ^ kFallOfLine[line] ^ ((now & line) != 0 ? kRise : 0U);
        };
        if ((changed & (changed - 1)) != 0) {
            for (const PulseLines line : kLinesInOrder) {
                if ((changed & line) != 0) {
                    add(line);
                }
            }
        } else if (changed != 0) {
            add(changed);
        }
    }
    levels_ = static_cast<PulseLines>(levels);
    if (out != digits_.data()) {
        fold(static_cast<std::size_t>(out - digits_.data()), end);
    }
}

void EdgeChecksum::fold(std::size_t count, std::uint32_t end)
{
    std::uint32_t x = remainder_ ^ digits_[0];
    std::size_t i = 1;
    for (; i + kEdgesAtOnce <= count; i += kEdgesAtOnce) {
        x = power<4>(x) ^ power<3>(digits_[i]) ^ power<2>(digits_[i + 1]) ^
            power<1>(digits_[i + 2]) ^ digits_[i + 3];
    }
    for (; i < count; ++i) {
        x = power<1>(x) ^ digits_[i];
    }
    remainder_ = power<1>(x) ^ end;
}

}  // namespace cusp::program_run
