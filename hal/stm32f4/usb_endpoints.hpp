// The endpoints of USB OTG FS: packets from and to its FIFOs, and what is set at a start and a reset
// (RM0090 section 34.17). Context: the interrupt of USB, but for start_usb().
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/span.hpp"
#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/usb_registers.hpp"
#include "hal/usb_serial/usb_descriptors.hpp"

namespace cusp::hal::stm32f4 {

using namespace usb_serial;

// How the block is told that a host is there, since PA9, which could feel it, is the serial port's.
enum class UsbSession : std::uint8_t {
    kNotSensed,   // STM32F405, F407, F411, F429: NOVBUSSENS of GCCFG
    kOverridden,  // STM32F446: that bit would switch the sensing on; BVALOEN of GOTGCTL
};

// Both wires of the plug; alternate function 10.
inline constexpr Pin kUsbMinus{'A', 11};
inline constexpr Pin kUsbPlus{'A', 12};

// An entry of the FIFO of what was received.
struct UsbReceived {
    static constexpr unsigned kData = 2;
    static constexpr unsigned kSetup = 6;

    unsigned endpoint;
    unsigned kind;
    unsigned size;  // bytes that follow it
};

namespace detail {

// Waits in an interrupt: what takes a microsecond, or nothing.
inline constexpr std::uint32_t kShortRounds = 500;

template <class Word>
void wait_shortly(Word& word, std::uint32_t mask, std::uint32_t value) noexcept
{
    for (std::uint32_t i = 0; i < kShortRounds && (word.read() & mask) != value; ++i) {
    }
}

}  // namespace detail

template <class Chip>
struct UsbEndpoints {
    static constexpr unsigned kBulk = 1;
    static constexpr unsigned kNotify = 2;

    static auto& core() noexcept { return Chip::usb(); }
    // The number that each chip has from its maker (RM0090 section 39.1).
    static std::array<std::uint32_t, 3> chip_number() noexcept
    {
        constexpr std::uint32_t kAddress = 0x1FFF7A10;
        return {Chip::read_memory(kAddress), Chip::read_memory(kAddress + 4),
                Chip::read_memory(kAddress + 8)};
    }
    static void ask_for_service() noexcept
    {
        Chip::interrupts().ispr[kUsbInterrupt / 32].write(1U << kUsbInterrupt % 32);
    }
    static bool suspended() noexcept { return (core().dsts.read() & 1U) != 0; }

    static UsbReceived pop() noexcept
    {
        const std::uint32_t entry = core().grxstsp.read();
        return {entry & 15U, entry >> 17U & 15U, entry >> 4U & 0x7FFU};
    }
    // Takes `size` bytes out of the FIFO. Returns how many of them `to` has room for.
    static unsigned read(Span<std::uint8_t> to, unsigned size) noexcept
    {
        constexpr unsigned kMost = 4 * 0x200;
        unsigned taken = 0;
        for (unsigned at = 0; at < size && at < kMost; at += 4) {
            std::uint32_t word = core().fifo[0].word.read();
            for (unsigned i = at; i < at + 4 && i < size && i < to.size(); ++i) {
                to[i] = static_cast<std::uint8_t>(word & 0xFFU);
                word >>= 8U;
                ++taken;
            }
        }
        return taken;
    }
    // A packet to the host. Precondition: the one before has left; it fits.
    static void send(unsigned endpoint, Span<const std::uint8_t> bytes) noexcept
    {
        auto& in = core().in[endpoint];
        in.tsiz.write(1U << 19U | static_cast<std::uint32_t>(bytes.size()));
        in.ctl.write((endpoint == 0 ? 0U : kBulkIn) | kUsbEnable | kUsbClearNak);
        for (std::size_t at = 0; at < bytes.size(); at += 4) {
            std::uint32_t word = 0;
            for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i) {
                word |= std::uint32_t{bytes[at + i]} << 8U * i;
            }
            core().fifo[endpoint].word.write(word);
        }
    }
    // SETUP packets come at any time; the block counts those that follow each other.
    static void await_setup() noexcept
    {
        core().out[0].tsiz.write(kThreeSetups | 1U << 19U | kUsbPacket);
    }
    static void receive_control() noexcept
    {
        await_setup();
        core().out[0].ctl.write(kUsbEnable | kUsbClearNak);
    }
    static void receive_bulk() noexcept
    {
        core().out[kBulk].tsiz.write(1U << 19U | kUsbPacket);
        core().out[kBulk].ctl.write(kBulkOut | kUsbEnable | kUsbClearNak);
    }
    // The next SETUP packet ends it.
    static void stall_control() noexcept
    {
        await_setup();
        core().in[0].ctl.write(kUsbStall);
        core().out[0].ctl.write(kUsbStall);
    }

    static bool in_done(unsigned endpoint) noexcept
    {
        const std::uint32_t events = core().in[endpoint].intr.read();
        core().in[endpoint].intr.write(events);
        return (events & kUsbTransferDone) != 0;
    }
    static std::uint32_t out_events(unsigned endpoint) noexcept
    {
        const std::uint32_t events = core().out[endpoint].intr.read();
        core().out[endpoint].intr.write(events);
        return events;
    }

    // A packet that the host has not fetched is none any more.
    static void cancel_in(unsigned endpoint) noexcept
    {
        auto& in = core().in[endpoint];
        const std::uint32_t was = in.ctl.read();
        if ((was & kUsbEnable) == 0) {
            return;
        }
        in.ctl.write((was & ~kUsbEnable) | kUsbSetNak);
        in.ctl.write((was & ~kUsbEnable) | kUsbDisable);
        detail::wait_shortly(in.intr, kUsbDisabled, kUsbDisabled);
        in.intr.write(kUsbDisabled | kUsbTransferDone);
        flush(endpoint);
    }
    static void flush(unsigned fifo) noexcept
    {
        constexpr std::uint32_t kFlush = 1U << 5U;
        core().grstctl.write(kFlush | fifo << 6U);
        detail::wait_shortly(core().grstctl, kFlush, 0);
    }

    // After a reset of the bus: endpoint 0 alone, at address 0.
    static void begin_control() noexcept
    {
        begin_bulk(false);
        cancel_in(0);
        core().out[0].ctl.write(kUsbSetNak);
        flush(kAllFifos);
        set_address(0);
        core().daintmsk.write(1U | 1U << 16U);
        await_setup();
    }
    static void begin_bulk(bool on) noexcept
    {
        cancel_in(kBulk);
        core().in[kBulk].ctl.write(on ? kBulkIn | kUsbDataZero | kUsbSetNak : kUsbSetNak);
        core().in[kNotify].ctl.write(on ? kNotifyIn | kUsbDataZero | kUsbSetNak : kUsbSetNak);
        core().out[kBulk].ctl.write(on ? kBulkOut | kUsbDataZero | kUsbSetNak : kUsbSetNak);
        core().daintmsk.write(on ? 7U | 3U << 16U : 1U | 1U << 16U);
    }
    // Precondition: begin_bulk(true). `resumed`: the endpoint that goes on with DATA0.
    static void halt(bool in, bool out, bool notify, std::uint8_t resumed) noexcept
    {
        const auto bits = [resumed](bool halted, unsigned endpoint) {
            return (halted ? kUsbStall : 0U) | (resumed == endpoint ? kUsbDataZero : 0U);
        };
        core().in[kBulk].ctl.write(kBulkIn | bits(in, kUsbBulkIn));
        core().out[kBulk].ctl.write(kBulkOut | bits(out, kUsbBulkOut));
        core().in[kNotify].ctl.write(kNotifyIn | bits(notify, kUsbNotify));
    }
    static void set_address(unsigned address) noexcept { set_field(core().dcfg, 4, 7, address); }

    static constexpr unsigned kAllFifos = 16;

private:
    static constexpr std::uint32_t kThreeSetups = 3U << 29U;
    static constexpr std::uint32_t kBulkKind = 2U << 18U;
    static constexpr std::uint32_t kNotifyKind = 3U << 18U;
    static constexpr std::uint32_t kBulkIn = kUsbActive | kBulkKind | 1U << 22U | kUsbPacket;
    static constexpr std::uint32_t kBulkOut = kUsbActive | kBulkKind | kUsbPacket;
    static constexpr std::uint32_t kNotifyIn = kUsbActive | kNotifyKind | 2U << 22U | 8U;
};

// From the block's reset to a device that connect_usb() shows to the host (RM0090 sections 34.17.1 and 34.17.3).
template <class Chip>
void start_usb(UsbSession session) noexcept
{
    constexpr std::uint32_t kIdle = 1U << 31U;
    constexpr std::uint32_t kCoreReset = 1U;
    constexpr std::uint32_t kInsidePhy = 1U << 6U;
    constexpr std::uint32_t kForceDevice = 1U << 30U;
    constexpr std::uint32_t kTurnaround = 6U << 10U;  // for buses of 32 MHz and more
    constexpr std::uint32_t kPhyOn = 1U << 16U;
    constexpr std::uint32_t kNotSensed = 1U << 21U;
    constexpr std::uint32_t kValidByForce = 3U << 6U;
    constexpr std::uint32_t kDisconnected = 1U << 1U;
    constexpr std::uint32_t kFullSpeed = 3;
    auto& core = Chip::usb();
    set_bits(core.gusbcfg, kInsidePhy);
    static_cast<void>(wait_for(core.grstctl, kIdle, kIdle));
    core.grstctl.write(kCoreReset);
    static_cast<void>(wait_for(core.grstctl, kCoreReset, 0));
    core.gusbcfg.write(kInsidePhy | kForceDevice | kTurnaround);
    static_cast<void>(wait_for(core.gintsts, 1, 0));  // in device mode
    core.gccfg.write(kPhyOn | (session == UsbSession::kNotSensed ? kNotSensed : 0U));
    if (session == UsbSession::kOverridden) {
        set_bits(core.gotgctl, kValidByForce);
    }
    core.dctl.write(kDisconnected);
    core.pcgcctl.write(0);
    core.dcfg.write(kFullSpeed);
    // Words of the 320 that there are: received, then of IN endpoints 0, 1 and 2.
    core.grxfsiz.write(96);
    core.dieptxf0.write(32U << 16U | 96U);
    core.dieptxf[0].write(64U << 16U | 128U);
    core.dieptxf[1].write(16U << 16U | 192U);
    UsbEndpoints<Chip>::flush(UsbEndpoints<Chip>::kAllFifos);
    core.diepmsk.write(kUsbTransferDone);
    core.doepmsk.write(kUsbTransferDone | kUsbSetupDone);
    core.gintsts.write(0xFFFFFFFF);
    core.gintmsk.write(kUsbReceived | kUsbSuspend | kUsbReset | kUsbEnumerated | kUsbInEvent |
                       kUsbOutEvent | kUsbWakeUp);
    core.gahbcfg.write(1);
}

// The pull-up on, so that a host sees the device.
template <class Chip>
void connect_usb() noexcept
{
    Chip::usb().dctl.write(0);
}

}  // namespace cusp::hal::stm32f4
