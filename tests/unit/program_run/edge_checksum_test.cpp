// The checksum of edges against a CRC-32 bit by bit.
#include "host_tools/controller/program_run/edge_checksum.hpp"

#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/judges/edge_crc.hpp"

namespace {

using namespace cusp;

PulseFrame frame_of(const std::vector<PulseEdge>& edges)
{
    PulseFrame frame;
    for (const PulseEdge& edge : edges) {
        frame.edges.try_push_back(edge);
    }
    return frame;
}

}  // namespace

TEST_GROUP(EdgeChecksum){};

TEST(EdgeChecksum, OfNoEdgeIsZero)
{
    program_run::EdgeChecksum checksum{0, 0};
    checksum.frame_played(0, {});
    LONGS_EQUAL(0, checksum.value());
}

TEST(EdgeChecksum, OracleKnowsTheCheckValueOfTheStandard)
{
    test::PlainCrc32 crc;
    for (const char byte : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) {
        crc.add(static_cast<std::uint8_t>(byte));
    }
    UNSIGNED_LONGS_EQUAL(0xCBF43926U, crc.value());
}

TEST(EdgeChecksum, TakesTimesBeyond32Bits)
{
    constexpr std::uint64_t kHour = 5ULL * 3600 * 1'000'000;
    program_run::EdgeChecksum checksum{1000, 0};
    checksum.frame_played(kHour, frame_of({{3, step_line(2), 0}}));
    test::PlainCrc32 crc;
    crc.add_edge(kHour - 1000 + 3, 4, true);
    UNSIGNED_LONGS_EQUAL(crc.value(), checksum.value());
}

TEST(EdgeChecksum, TakesDirectionsBeforeStepsAndAxesInTheirOrder)
{
    program_run::EdgeChecksum checksum{0, step_line(0)};
    checksum.frame_played(
        2000,
        frame_of({{7, static_cast<PulseLines>(direction_line(1) | step_line(1) | step_line(2)),
                   step_line(0)}}));
    test::PlainCrc32 crc;
    crc.add_edge(2007, 0, false);
    crc.add_edge(2007, 3, true);
    crc.add_edge(2007, 2, true);
    crc.add_edge(2007, 4, true);
    UNSIGNED_LONGS_EQUAL(crc.value(), checksum.value());
}

TEST(EdgeChecksum, PassesOverFramesBeforeTheStartAndLevelsThatStay)
{
    program_run::EdgeChecksum checksum{1000, step_line(0)};
    checksum.frame_played(0, frame_of({{1, step_line(1), 0}}));
    checksum.frame_played(1000, frame_of({{1, step_line(0), 0}}));
    LONGS_EQUAL(0, checksum.value());
}

// Frames of 0 to 40 edges across the 2^32 us after which the upper half of the tick changes; some
// pulse ticks move several lines, some none.
TEST(EdgeChecksum, IsThatOfTheBytesOverManyFrames)
{
    std::mt19937_64 random{20261125};
    constexpr std::uint64_t kStart = (1ULL << 32U) - 200'500;
    program_run::EdgeChecksum checksum{0, 0};
    test::PlainCrc32 crc;
    unsigned levels = 0;
    for (std::uint64_t frame = 0; frame < 400; ++frame) {
        PulseFrame played;
        const std::uint64_t start = kStart + frame * kPulseTicksPerFrame;
        const auto edges = random() % 41;
        for (std::uint64_t i = 0; i < edges; ++i) {
            const auto tick = static_cast<std::uint16_t>(i * 24 + random() % 24);
            const unsigned lines = random() % 4 == 0 ? random() & 255U : 1U << random() % 8;
            const auto raise = static_cast<PulseLines>(lines & random());
            const auto lower = static_cast<PulseLines>(lines & ~unsigned{raise});
            played.edges.try_push_back({tick, raise, lower});
            const unsigned now = (levels | raise) & ~unsigned{lower};
            for (unsigned wire : {1U, 0U, 3U, 2U, 5U, 4U}) {
                const unsigned line =
                    wire % 2 == 0 ? step_line(wire / 2) : direction_line(wire / 2);
                if (((now ^ levels) & line) != 0) {
                    crc.add_edge(start + tick, wire, (now & line) != 0);
                }
            }
            levels = now;
        }
        checksum.frame_played(start, played);
        UNSIGNED_LONGS_EQUAL(crc.value(), checksum.value());
    }
}
