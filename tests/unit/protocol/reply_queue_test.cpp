#include "firmware/protocol/reply_queue.hpp"

#include <cstdint>
#include <string>

#include "CppUTest/TestHarness.h"

using cusp::protocol::ReplyQueue;

TEST_GROUP(Reply)
{
    ReplyQueue queue;
    std::string taken()
    {
        std::string text;
        while (!queue.empty()) {
            const auto pending = queue.pending();
            text.append(pending.begin(), pending.end());
            queue.drop(static_cast<std::uint32_t>(pending.size()));
        }
        return text;
    }
    std::string decimal(std::int64_t scaled, unsigned decimals)
    {
        (void)queue.decimal(scaled, decimals);
        return taken();
    }
};

TEST(Reply, WritesDecimals)
{
    CHECK_EQUAL(std::string{"0.000"}, decimal(0, 3));
    CHECK_EQUAL(std::string{"-0.005"}, decimal(-5, 3));
    CHECK_EQUAL(std::string{"12.345"}, decimal(12345, 3));
    CHECK_EQUAL(std::string{"10.0"}, decimal(100, 1));
    CHECK_EQUAL(std::string{"100"}, decimal(100, 0));
    CHECK_EQUAL(std::string{"-9223372036854775.808"}, decimal(INT64_MIN, 3));
}

TEST(Reply, RoundsPositionsToTheNearestMicrometreOrTenThousandthOfAnInch)
{
    write_position(queue, {1499, -1500, 499}, {});
    CHECK_EQUAL(std::string{"0.001,-0.002,0.000"}, taken());
    write_position(queue, {25400000, -1270, 1269}, {true, cusp::kLinearAxes});
    CHECK_EQUAL(std::string{"1.0000,-0.0001,0.0000"}, taken());
    // Degrees stay degrees.
    write_position(queue, {25400000, 0, 0, 12345600}, {true, cusp::kAxisCount});
    CHECK_EQUAL(std::string{"1.0000,0.0000,0.0000,12.346"}, taken());
}

TEST(Reply, KeepsItsBytesInOrderAroundTheEndOfItsRing)
{
    std::string expected;
    std::string all;
    for (unsigned i = 0; i < 400; ++i) {
        (void)queue.number(i).end_line();
        expected += std::to_string(i) + "\r\n";
        all += taken();
    }
    CHECK_EQUAL(expected, all);
}

TEST(Reply, ScalesToTheNearest)
{
    LONGS_EQUAL(10, cusp::protocol::scaled(0.010F, 3));
    LONGS_EQUAL(314961, cusp::protocol::scaled(314.961F, 3));
    LONGS_EQUAL(-3, cusp::protocol::scaled(-2.5F, 0));
}
