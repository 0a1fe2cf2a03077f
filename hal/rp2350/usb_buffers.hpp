// The endpoints of the USB block: packets in its memory, and what is set at a start and a reset (data sheet, 12.7).
// Context: the interrupt of USB, but for start_usb().
//
// Each endpoint has one buffer of 64 bytes and a word that says who owns it. The word is written in two steps: the block
// runs from another clock and takes a buffer as soon as it sees kAvailable.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/span.hpp"
#include "hal/rp2350/rp2350.hpp"
#include "hal/usb_serial/usb_descriptors.hpp"

namespace cusp::hal::rp2350 {

using namespace usb_serial;

// SIE_STATUS, and INTS.
inline constexpr std::uint32_t kUsbSuspended = 1U << 4U;
inline constexpr std::uint32_t kUsbResumed = 1U << 11U;
inline constexpr std::uint32_t kUsbSetupCame = 1U << 17U;
inline constexpr std::uint32_t kUsbResetCame = 1U << 19U;
inline constexpr std::uint32_t kUsbBufferEvent = 1U << 4U;
inline constexpr std::uint32_t kUsbResetEvent = 1U << 12U;
inline constexpr std::uint32_t kUsbSuspendEvent = 1U << 14U;
inline constexpr std::uint32_t kUsbResumeEvent = 1U << 15U;
inline constexpr std::uint32_t kUsbSetupEvent = 1U << 16U;

template <class Chip>
class UsbEndpoints {
public:
    static constexpr unsigned kBulk = 1;
    static constexpr unsigned kNotify = 2;

    // From the chip's memory for one-time values: four rows of 16 bits, random (13.7.1).
    static std::array<std::uint32_t, 3> chip_number() noexcept
    {
        constexpr std::uint32_t kRows = 0x40130000;
        return {Chip::read_memory(kRows + 4), Chip::read_memory(kRows), 0};
    }
    static void ask_for_service() noexcept
    {
        Chip::interrupts().ispr[kUsbInterrupt / 32].write(1U << kUsbInterrupt % 32);
    }

    // Places of buffers, in the order of BUFF_STATUS: IN, then OUT of each endpoint.
    static constexpr unsigned in_place(unsigned endpoint) noexcept { return 2 * endpoint; }
    static constexpr unsigned out_place(unsigned endpoint) noexcept { return 2 * endpoint + 1; }

    static std::array<std::uint8_t, 8> setup() noexcept
    {
        std::array<std::uint8_t, 8> bytes{};
        for (unsigned i = 0; i < bytes.size(); ++i) {
            bytes[i] = static_cast<std::uint8_t>(memory().setup[i / 4].read() >> i % 4 * 8);
        }
        return bytes;
    }
    // The packet that an OUT endpoint has received. Returns its size.
    static unsigned read(unsigned endpoint, Span<std::uint8_t> to) noexcept
    {
        const std::uint32_t received = memory().buffer[out_place(endpoint)].read() & kSizeMask;
        const unsigned size = received < to.size() ? received : static_cast<unsigned>(to.size());
        auto* words = &memory().data[first_word(out_place(endpoint))];
        for (unsigned at = 0; at < size; at += 4) {
            const std::uint32_t word = words[at / 4].read();
            for (unsigned i = at; i < at + 4 && i < size; ++i) {
                to[i] = static_cast<std::uint8_t>(word >> i % 4 * 8);
            }
        }
        return size;
    }
    // A packet to the host. Precondition: the one before has left; it fits.
    static void send(unsigned endpoint, Span<const std::uint8_t> bytes) noexcept
    {
        const unsigned place = in_place(endpoint);
        auto* words = &memory().data[first_word(place)];
        for (std::size_t at = 0; at < bytes.size(); at += 4) {
            std::uint32_t word = 0;
            for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i) {
                word |= std::uint32_t{bytes[at + i]} << 8U * i;
            }
            words[at / 4].write(word);
        }
        give(place, kFull | static_cast<std::uint32_t>(bytes.size()));
    }
    // SETUP packets come at any time.
    static void await_setup() noexcept {}
    static void receive_control() noexcept { give(out_place(0), kUsbPacket); }
    static void receive_bulk() noexcept { give(out_place(kBulk), kUsbPacket); }
    // The next SETUP packet ends it.
    static void stall_control() noexcept
    {
        Chip::usb().ep_stall_arm.write(3);
        memory().buffer[in_place(0)].write(kStall);
        memory().buffer[out_place(0)].write(kStall);
    }
    // A packet that the host has not fetched is none any more: the next has its DATA0 or DATA1. Of endpoint 0, after a
    // SETUP packet: what was under way both ways is over, and DATA1 follows.
    static void cancel_in(unsigned endpoint) noexcept
    {
        const unsigned place = in_place(endpoint);
        const bool was_out = take_back(place);
        if (endpoint == 0) {
            take_back(out_place(0));
            odd_[in_place(0)] = true;
            odd_[out_place(0)] = true;
        } else if (was_out) {
            odd_[place] = !odd_[place];
        }
    }
    // A buffer that the block has given back.
    static void finish(unsigned place) noexcept
    {
        given_[place] = 0;
        if (place == in_place(0)) {
            Chip::usb().addr_endp[0].write(address_);
        }
    }

    // After a reset of the bus: endpoint 0 alone, at address 0.
    static void begin_control() noexcept
    {
        begin_bulk(false);
        cancel_in(0);
        address_ = 0;
        Chip::usb().addr_endp[0].write(0);
    }
    static void begin_bulk(bool on) noexcept
    {
        for (const unsigned place : {in_place(kBulk), out_place(kBulk), in_place(kNotify)}) {
            take_back(place);
            odd_[place] = false;
            const std::uint32_t kind = place == in_place(kNotify) ? kInterruptKind : kBulkKind;
            // The controls of endpoint 0 would come first.
            memory().control[place - 2].write(
                on ? kOn | kEachBuffer | kind | (kDataPlace + first_word(place) * 4) : 0U);
        }
    }
    // Precondition: begin_bulk(true). `resumed`: the endpoint that goes on with DATA0.
    static void halt(bool in, bool out, bool notify, std::uint8_t resumed) noexcept
    {
        halt_one(in_place(kBulk), in, resumed == kUsbBulkIn);
        halt_one(out_place(kBulk), out, resumed == kUsbBulkOut);
        halt_one(in_place(kNotify), notify, resumed == kUsbNotify);
    }
    // From the end of the request on: its status goes to the old address.
    static void set_address(unsigned address) noexcept { address_ = address; }

private:
    static constexpr std::uint32_t kSizeMask = 0x3FF;
    static constexpr std::uint32_t kAvailable = 1U << 10U;
    static constexpr std::uint32_t kStall = 1U << 11U;
    static constexpr std::uint32_t kDataOne = 1U << 13U;
    static constexpr std::uint32_t kFull = 1U << 15U;
    static constexpr std::uint32_t kOn = 1U << 31U;
    static constexpr std::uint32_t kEachBuffer = 1U << 29U;
    static constexpr std::uint32_t kBulkKind = 2U << 26U;
    static constexpr std::uint32_t kInterruptKind = 3U << 26U;
    static constexpr std::uint32_t kDataPlace = 0x100;
    static constexpr unsigned kPlaces = 6;
    static constexpr unsigned kAbortRounds = 500;

    static auto& memory() noexcept { return Chip::usb_memory(); }
    // Both ways of endpoint 0 share the first buffer, by the hardware; its second is not used.
    static constexpr unsigned first_word(unsigned place) noexcept
    {
        return place < 2 ? 0 : place * kUsbPacket / 4;
    }
    // The block must see the rest of the word before kAvailable (12.7.3.7.1).
    static void give(unsigned place, std::uint32_t word) noexcept
    {
        word |= odd_[place] ? kDataOne : 0U;
        odd_[place] = !odd_[place];
        hand_over(place, word);
    }
    static void hand_over(unsigned place, std::uint32_t word) noexcept
    {
        constexpr unsigned kReads = 12;  // a few cycles of the slower clock
        given_[place] = word;
        auto& buffer = memory().buffer[place];
        buffer.write(word);
        for (unsigned i = 0; i < kReads; ++i) {
            static_cast<void>(buffer.read());
        }
        buffer.write(word | kAvailable);
    }
    // True where the block still had it.
    static bool take_back(unsigned place) noexcept
    {
        auto& usb = Chip::usb();
        auto& buffer = memory().buffer[place];
        const std::uint32_t bit = 1U << place;
        bool was_out = (buffer.read() & kAvailable) != 0;
        if (was_out) {
            usb.ep_abort.write(bit);
            for (unsigned i = 0; i < kAbortRounds && (usb.ep_abort_done.read() & bit) == 0; ++i) {
            }
            was_out = (buffer.read() & kAvailable) != 0;
        }
        buffer.write(0);
        usb.ep_abort.write(0);
        usb.ep_abort_done.write(bit);
        usb.buff_status.write(bit);
        given_[place] = 0;
        return was_out;
    }
    static void halt_one(unsigned place, bool halted, bool resumed) noexcept
    {
        auto& buffer = memory().buffer[place];
        if (halted) {
            const std::uint32_t given = given_[place];
            take_back(place);
            given_[place] = given;
            buffer.write(kStall);
            return;
        }
        if (!resumed) {
            return;
        }
        // A packet on its way before goes on, with DATA0.
        const std::uint32_t given = given_[place];
        take_back(place);
        odd_[place] = false;
        if (given != 0) {
            give(place, given & ~kDataOne);
        }
    }

    static inline std::array<bool, kPlaces> odd_{};  // the next packet is DATA1
    static inline std::array<std::uint32_t, kPlaces>
        given_{};  // words of buffers that the block has
    static inline unsigned address_{0};
};

// From the block's reset to a device that connect_usb() shows to the host (12.7.2).
template <class Chip>
void start_usb() noexcept
{
    constexpr std::uint32_t kToPhy = 1U << 0U | 1U << 3U;
    constexpr std::uint32_t kPlugByForce = 1U << 2U | 1U << 3U;
    constexpr std::uint32_t kDevice = 1U << 0U;  // its PHY isolated no more
    constexpr std::uint32_t kEachControlBuffer = 1U << 29U;
    auto& usb = Chip::usb();
    for (auto& word : Chip::usb_memory().setup) {
        word.write(0);
    }
    for (auto& word : Chip::usb_memory().control) {
        word.write(0);
    }
    for (auto& word : Chip::usb_memory().buffer) {
        word.write(0);
    }
    usb.muxing.write(kToPhy);
    usb.pwr.write(kPlugByForce);
    usb.main_ctrl.write(kDevice);
    usb.sie_ctrl.write(kEachControlBuffer);
    usb.inte.write(kUsbBufferEvent | kUsbResetEvent | kUsbSuspendEvent | kUsbResumeEvent |
                   kUsbSetupEvent);
}

// The pull-up on, so that a host sees the device.
template <class Chip>
void connect_usb() noexcept
{
    constexpr std::uint32_t kPullUp = 1U << 16U;
    set_bits(Chip::usb().sie_ctrl, kPullUp);
}

}  // namespace cusp::hal::rp2350
