// The serial port over the RP2350's USB, against a host that speaks with a model of its buffers.
#include "hal/rp2350/usb_device.hpp"

#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_rp2350/pico_model.hpp"

using namespace cusp::hal::rp2350;
using cusp::test::PicoChip;
using cusp::test::PicoModel;

namespace {

struct Table {
    static constexpr UsbIdentity kUsb{0x1209, 0x0001, "test"};
};
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kAvailable = 1U << 10U;
constexpr std::uint32_t kStalls = 1U << 11U;
constexpr std::uint32_t kDataOne = 1U << 13U;

}  // namespace

TEST_GROUP(UsbDevice)
{
    PicoModel chip;
    UsbLink<PicoChip, Table> link;

    void setup() override
    {
        link.start();
        link.connect();
        reset_bus();
    }
    void reset_bus()
    {
        chip.usb.sie_status.value |= 1U << 19U;
        link.on_interrupt();
    }
    static std::uint8_t byte_of(std::uint32_t word, unsigned at)
    {
        return static_cast<std::uint8_t>(word >> at % 4 * 8);
    }
    std::uint32_t& buffer(unsigned place) { return chip.usb_memory.buffer[place].value; }
    static unsigned data_at(unsigned place) { return place < 2 ? 0 : place * 16; }
    // A packet from the device; false where it has none: NAK.
    bool fetch(unsigned endpoint, Bytes& bytes, bool odd)
    {
        const unsigned place = 2 * endpoint;
        if ((buffer(place) & kAvailable) == 0) {
            return false;
        }
        CHECK_EQUAL(odd, (buffer(place) & kDataOne) != 0);
        for (unsigned i = 0; i < (buffer(place) & 0x3FFU); ++i) {
            bytes.push_back(byte_of(chip.usb_memory.data[data_at(place) + i / 4].value, i));
        }
        finish(place);
        return true;
    }
    bool give(unsigned endpoint, const Bytes& bytes, bool odd)
    {
        const unsigned place = 2 * endpoint + 1;
        if ((buffer(place) & kAvailable) == 0) {
            return false;
        }
        CHECK_EQUAL(odd, (buffer(place) & kDataOne) != 0);
        for (unsigned i = 0; i < bytes.size(); ++i) {
            std::uint32_t& word = chip.usb_memory.data[data_at(place) + i / 4].value;
            word = (word & ~(0xFFU << i % 4 * 8)) | std::uint32_t{bytes[i]} << i % 4 * 8;
        }
        buffer(place) = (buffer(place) & ~0x3FFU) | static_cast<std::uint32_t>(bytes.size());
        finish(place);
        return true;
    }
    void finish(unsigned place)
    {
        buffer(place) &= ~kAvailable;
        chip.usb.buff_status.value |= 1U << place;
        link.on_interrupt();
    }
    void send_setup(const Bytes& bytes)
    {
        chip.usb.ep_stall_arm.value = 0;
        for (unsigned i = 0; i < 2; ++i) {
            chip.usb_memory.setup[i].value = 0;
            for (unsigned k = 0; k < 4; ++k) {
                chip.usb_memory.setup[i].value |= std::uint32_t{bytes[4 * i + k]} << 8 * k;
            }
        }
        chip.usb.sie_status.value |= 1U << 17U;
        link.on_interrupt();
    }
    bool stalled() { return chip.usb.ep_stall_arm.value == 3 && (buffer(0) & kStalls) != 0; }
    // A request with its answer.
    Bytes ask(const Bytes& setup)
    {
        send_setup(setup);
        Bytes answer;
        bool odd = true;
        while (fetch(0, answer, odd) && answer.size() % 64 == 0 && !answer.empty()) {
            odd = !odd;
        }
        CHECK_TRUE(give(0, {}, true));
        return answer;
    }
    // One without an answer.
    bool order(const Bytes& setup)
    {
        send_setup(setup);
        Bytes nothing;
        return fetch(0, nothing, true) && nothing.empty();
    }
    void enumerate()
    {
        CHECK_TRUE(order({0x00, 5, 42, 0, 0, 0, 0, 0}));
        CHECK_TRUE(order({0x00, 9, 1, 0, 0, 0, 0, 0}));
        CHECK_TRUE(order({0x21, 0x22, 1, 0, 0, 0, 0, 0}));
    }
    std::string read_all()
    {
        std::string text;
        std::uint8_t byte = 0;
        while (link.try_read(byte)) {
            text += static_cast<char>(byte);
        }
        link.on_interrupt();
        return text;
    }
};

TEST(UsbDevice, IsShownToTheHostWhenItConnects)
{
    CHECK_TRUE((chip.usb.sie_ctrl.value & 1U << 16U) != 0);
    LONGS_EQUAL(1, chip.usb.main_ctrl.value);
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, AnswersWithItsDescriptors)
{
    const Bytes device = ask({0x80, 6, 0, 1, 0, 0, 64, 0});
    LONGS_EQUAL(18, device.size());
    LONGS_EQUAL(0x09, device[8]);
    LONGS_EQUAL(0x12, device[9]);
    // More than a packet: 75 bytes of 255 that were asked for.
    const Bytes configuration = ask({0x80, 6, 0, 2, 0, 0, 255, 0});
    LONGS_EQUAL(75, configuration.size());
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, TakesItsAddressAfterTheStatus)
{
    send_setup({0x00, 5, 42, 0, 0, 0, 0, 0});
    LONGS_EQUAL(0, chip.usb.addr_endp[0].value);
    Bytes nothing;
    CHECK_TRUE(fetch(0, nothing, true));
    LONGS_EQUAL(42, chip.usb.addr_endp[0].value);
    reset_bus();
    LONGS_EQUAL(0, chip.usb.addr_endp[0].value);
}

TEST(UsbDevice, StallsWhatItDoesNotKnowAndGoesOn)
{
    send_setup({0x40, 99, 0, 0, 0, 0, 0, 0});
    CHECK_TRUE(stalled());
    LONGS_EQUAL(18, ask({0x80, 6, 0, 1, 0, 0, 18, 0}).size());
    CHECK_FALSE(stalled());
}

TEST(UsbDevice, TakesALineCodingAndGivesItBack)
{
    enumerate();
    send_setup({0x21, 0x20, 0, 0, 0, 0, 7, 0});
    const Bytes coding{0x00, 0x84, 0x03, 0x00, 0, 0, 8};
    CHECK_TRUE(give(0, coding, true));
    Bytes nothing;
    CHECK_TRUE(fetch(0, nothing, true));
    CHECK_TRUE(ask({0xA1, 0x21, 0, 0, 0, 0, 7, 0}) == coding);
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, GivesUpAnAnswerWhereAnotherSetupComes)
{
    send_setup({0x80, 6, 0, 2, 0, 0, 255, 0});
    CHECK_TRUE((buffer(0) & kAvailable) != 0);
    LONGS_EQUAL(18, ask({0x80, 6, 0, 1, 0, 0, 18, 0}).size());
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, CarriesBytesBothWays)
{
    enumerate();
    CHECK_TRUE(link.open());
    bool odd = false;
    std::string text;
    for (unsigned k = 0; k < 20; ++k) {
        Bytes packet;
        for (unsigned i = 0; i < 1 + k * 3; ++i) {
            packet.push_back(static_cast<std::uint8_t>('a' + (i + k) % 26));
            text += static_cast<char>(packet.back());
        }
        CHECK_TRUE(give(1, packet, odd));
        odd = !odd;
        if (k % 5 == 4) {
            const std::string read = read_all();
            CHECK_TRUE(text == read);
            text.clear();
        }
    }
    Bytes out;
    for (unsigned i = 0; i < 200; ++i) {
        out.push_back(static_cast<std::uint8_t>(i));
    }
    link.write({out.data(), out.size()});
    link.on_interrupt();
    Bytes in;
    bool in_odd = false;
    while (in.size() < out.size() && fetch(1, in, in_odd)) {
        in_odd = !in_odd;
    }
    CHECK_TRUE(in == out);
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, HoldsBackAHostThatSendsMoreThanIsRead)
{
    enumerate();
    const Bytes packet(64, 'x');
    unsigned taken = 0;
    while (taken < 100 && give(1, packet, taken % 2 != 0)) {
        ++taken;
    }
    LONGS_EQUAL(8, taken);
    LONGS_EQUAL(512, read_all().size());
    CHECK_TRUE(give(1, packet, false));
}

TEST(UsbDevice, GoesOnAfterAHaltWithDataZero)
{
    enumerate();
    CHECK_TRUE(give(1, {1, 2, 3}, false));
    CHECK_TRUE(order({0x02, 3, 0, 0, 0x01, 0, 0, 0}));
    CHECK_FALSE(give(1, {4}, true));
    CHECK_TRUE((buffer(3) & kStalls) != 0);
    CHECK_TRUE(order({0x02, 1, 0, 0, 0x01, 0, 0, 0}));
    CHECK_TRUE(give(1, {4}, false));
    LONGS_EQUAL(4, read_all().size());
    // The other way: the packet that waited comes after the halt.
    const Bytes out{7, 8};
    link.write({out.data(), out.size()});
    link.on_interrupt();
    CHECK_TRUE(order({0x02, 3, 0, 0, 0x81, 0, 0, 0}));
    Bytes in;
    CHECK_FALSE(fetch(1, in, false));
    CHECK_TRUE(order({0x02, 1, 0, 0, 0x81, 0, 0, 0}));
    CHECK_TRUE(fetch(1, in, false));
    CHECK_TRUE(in == out);
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, DropsWhatNobodyFetchedAndGoesOnWithTheSameData)
{
    enumerate();
    const Bytes old{1, 2, 3};
    const Bytes fresh{4, 5};
    link.write({old.data(), old.size()});
    link.on_interrupt();
    // The port is closed and opened again.
    CHECK_TRUE(order({0x21, 0x22, 0, 0, 0, 0, 0, 0}));
    CHECK_TRUE(order({0x21, 0x22, 1, 0, 0, 0, 0, 0}));
    link.write({fresh.data(), fresh.size()});
    link.on_interrupt();
    Bytes in;
    CHECK_TRUE(fetch(1, in, false));
    CHECK_TRUE(in == fresh);
    LONGS_EQUAL(0, chip.violations);
}

TEST(UsbDevice, TellsThatTheSenderHasLeftWhereTheBusFallsSilent)
{
    enumerate();
    CHECK_FALSE(link.sender_left());
    chip.usb.sie_status.value |= 1U << 4U;
    link.on_interrupt();
    CHECK_FALSE(link.open());
    CHECK_TRUE(link.sender_left());
    chip.usb.sie_status.value |= 1U << 11U;
    link.on_interrupt();
    CHECK_TRUE(link.open());
}
