// The simulated serial line.
#include "hal/sim/simulated_link.hpp"

#include "CppUTest/TestHarness.h"

using cusp::hal::SimulatedLink;

namespace {

std::string read_all(SimulatedLink& link)
{
    std::string text;
    std::uint8_t byte = 0;
    while (link.try_read(byte)) {
        text.push_back(static_cast<char>(byte));
    }
    return text;
}

}  // namespace

TEST_GROUP(SimulatedLink) { SimulatedLink link; };

TEST(SimulatedLink, DeliversBytesInOrder)
{
    link.send("G1 ");
    link.send("X1\n");
    STRCMP_EQUAL("G1 X1\n", read_all(link).c_str());
}

TEST(SimulatedLink, GivesBackWhatTheControllerSays)
{
    const std::uint8_t ok[] = {'o', 'k', '\r', '\n'};
    link.write(ok);
    STRCMP_EQUAL("ok\r\n", link.take_answers().c_str());
    CHECK(link.idle());
}

TEST(SimulatedLink, LetsTenBitsAByteThroughAtItsBitRate)
{
    link.set_bits_per_second(100'000);
    link.send(std::string(50, 'x'));
    STRCMP_EQUAL("", read_all(link).c_str());
    link.advance();
    LONGS_EQUAL(10, read_all(link).size());
    for (int tick = 0; tick < 4; ++tick) {
        link.advance();
    }
    LONGS_EQUAL(40, read_all(link).size());
}

TEST(SimulatedLink, SavesNoTimeUpWhileItIsSilent)
{
    link.set_bits_per_second(100'000);
    for (int tick = 0; tick < 1000; ++tick) {
        link.advance();
    }
    link.send(std::string(50, 'x'));
    LONGS_EQUAL(10, read_all(link).size());
}

TEST(SimulatedLink, TellsOfAnOverrunOnce)
{
    link.mark_overrun();
    CHECK(link.overrun());
    CHECK_FALSE(link.overrun());
}
