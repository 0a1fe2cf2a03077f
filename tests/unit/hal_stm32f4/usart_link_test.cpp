// The serial line against the model of the port.
#include "hal/stm32f4/usart_link.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_stm32f4/chip_model.hpp"

using cusp::test::ChipModel;
using cusp::test::ModelChip;

namespace {

struct Rules {
    static constexpr bool kTransmitInterrupt = true;
};
using Link = cusp::hal::stm32f4::UsartLink<ModelChip, Rules>;
static_assert(cusp::hal::is_byte_link<Link>());

constexpr std::uint32_t kOverrun = 1U << 3U;
constexpr std::uint32_t kReceived = 1U << 5U;
constexpr std::uint32_t kTransmitEmpty = 1U << 7U;

}  // namespace

TEST_GROUP(UsartLink)
{
    ChipModel chip;
    Link link;

    void setup() override { link.start(84000000, 115200); }
    void receive(std::uint8_t byte, std::uint32_t state = kReceived)
    {
        chip.usart1.sr.value = state;
        chip.usart1.dr.value = byte;
        link.on_interrupt();
    }
    bool transmit_interrupt_on() const { return (chip.usart1.cr1.value & 1U << 7U) != 0; }
};

TEST(UsartLink, RunsWithinOneAndAHalfPercentOfTheRate) { LONGS_EQUAL(729, chip.usart1.brr.value); }

TEST(UsartLink, HandsBytesOverInOrder)
{
    receive('a');
    receive('b');
    std::uint8_t byte = 0;
    CHECK_TRUE(link.try_read(byte));
    LONGS_EQUAL('a', byte);
    CHECK_TRUE(link.try_read(byte));
    LONGS_EQUAL('b', byte);
    CHECK_FALSE(link.try_read(byte));
    CHECK_FALSE(link.overrun());
}

TEST(UsartLink, TellsOnceOfBytesThatThePortLost)
{
    receive('a', kReceived | kOverrun);
    CHECK_TRUE(link.overrun());
    CHECK_FALSE(link.overrun());
    std::uint8_t byte = 0;
    CHECK_TRUE(link.try_read(byte));
}

TEST(UsartLink, TellsOfBytesThatFoundNoRoom)
{
    for (unsigned i = 0; i < 512; ++i) {
        receive('x');
    }
    CHECK_FALSE(link.overrun());
    receive('y');
    CHECK_TRUE(link.overrun());
}

TEST(UsartLink, SendsByInterruptAndFallsSilent)
{
    const std::array<std::uint8_t, 2> bytes{'o', 'k'};
    const std::uint32_t room = link.write_room();
    link.write(bytes);
    LONGS_EQUAL(room - 2, link.write_room());
    CHECK_TRUE(transmit_interrupt_on());
    std::string sent;
    for (unsigned i = 0; i < 5 && transmit_interrupt_on(); ++i) {
        chip.usart1.sr.value = kTransmitEmpty;
        chip.usart1.dr.value = 0;
        link.on_interrupt();
        if (chip.usart1.dr.value != 0) {
            sent += static_cast<char>(chip.usart1.dr.value);
        }
    }
    STRCMP_EQUAL("ok", sent.c_str());
    CHECK_FALSE(transmit_interrupt_on());
    LONGS_EQUAL(room, link.write_room());
}
