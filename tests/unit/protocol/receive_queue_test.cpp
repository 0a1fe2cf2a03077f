#include "firmware/protocol/receive_queue.hpp"

#include "CppUTest/TestHarness.h"

#include "firmware/protocol/realtime_command.hpp"

using namespace cusp::protocol;

TEST_GROUP(Queue)
{
    ReceiveQueue queue;
    std::uint8_t byte{0};
};

TEST(Queue, HoldsAThousandAndTwentyFourBytes)
{
    for (unsigned i = 0; i < 1024; ++i) {
        queue.put(static_cast<std::uint8_t>(i));
    }
    CHECK_FALSE(queue.lost());
    UNSIGNED_LONGS_EQUAL(0, queue.room());
    for (unsigned i = 0; i < 1024; ++i) {
        CHECK(queue.take(byte));
        UNSIGNED_LONGS_EQUAL(i & 0xFFU, byte);
    }
    CHECK_FALSE(queue.take(byte));
}

TEST(Queue, TellsOfLostLineEndsOnceEverythingBeforeThemIsRead)
{
    for (unsigned i = 0; i < 1024; ++i) {
        queue.put('A');
    }
    for (const char c : {'X', '\n', 'Y', '\n', 'Z'}) {
        queue.put(static_cast<std::uint8_t>(c));
    }
    CHECK_FALSE(queue.lost());
    while (queue.take(byte)) {
        // Lost bytes stay lost, though there would be room now.
        queue.put('B');
    }
    CHECK(queue.lost());
    CHECK_FALSE(queue.loss_ended_a_line());
    UNSIGNED_LONGS_EQUAL(2, queue.take_lost_line_ends());
    CHECK_FALSE(queue.lost());
    queue.put('C');
    CHECK(queue.take(byte));
    BYTES_EQUAL('C', byte);
}

TEST(Queue, KnowsEveryRealtimeByteOfGrbl)
{
    unsigned realtime = 0;
    unsigned dropped = 0;
    for (unsigned b = 0; b < 256; ++b) {
        realtime += byte_kind(static_cast<std::uint8_t>(b)) == ByteKind::kRealtime ? 1U : 0U;
        dropped += byte_kind(static_cast<std::uint8_t>(b)) == ByteKind::kDropped ? 1U : 0U;
    }
    UNSIGNED_LONGS_EQUAL(22, realtime);
    UNSIGNED_LONGS_EQUAL(128 - 18, dropped);
}
