// The serial line against the model of the port.
#include "hal/qemu/usart_link.hpp"

#include <array>
#include <cstdint>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_stm32f4/chip_model.hpp"

using cusp::test::ChipModel;
using cusp::test::ModelChip;

namespace {

using Link = cusp::hal::qemu::UsartLink<ModelChip>;
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

TEST(UsartLink, WaitsForThePortAndSends)
{
    chip.usart1.sr.value = kTransmitEmpty;
    const std::array<std::uint8_t, 2> bytes{'o', 'k'};
    link.write(bytes);
    LONGS_EQUAL('k', chip.usart1.dr.value);
}

TEST(UsartLink, WaitsABoundedTimeForAPortThatStaysFull)
{
    chip.usart1.sr.value = 0;
    const std::array<std::uint8_t, 1> bytes{'x'};
    link.write(bytes);
    LONGS_EQUAL('x', chip.usart1.dr.value);
}
