// The registers of the RP2350 that this firmware touches, by the names of its data sheet in lower case. A comment
// names the chapter of each block.
//
// Each block is a template over its word type: DeviceWord on the chip; in the tests a word that reports each access
// to a model of the chip (tests/unit/hal_rp2350).
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/cortex_m/cortex_m.hpp"

namespace cusp::hal::rp2350 {

using namespace cortex_m;

inline constexpr unsigned kPinCount = 30;  // of the RP2350A

// 7.5: which blocks are held in reset.
template <class Word>
struct Resets {
    Word reset, wdsel, done;
};

// 7.4: what the watchdog resets.
template <class Word>
struct PowerSequence {
    Word force_on, force_off, wdsel, done;
};

// 8.1: the clocks.
template <class Word>
struct Clock {
    Word ctrl, div, selected;
};
template <class Word>
struct Clocks {
    Clock<Word> gpout[4], ref, sys, peri, hstx, usb, adc;
};
static_assert(offsetof(Clocks<DeviceWord>, ref) == 0x30);
static_assert(offsetof(Clocks<DeviceWord>, usb) == 0x60);

// 8.2 and 8.6: the crystal, and a multiplier of its rate.
template <class Word>
struct Crystal {
    Word ctrl, status, dormant, startup;
};
template <class Word>
struct Multiplier {
    Word cs, pwr, fbdiv, prim;
};

// 8.5: ticks of a microsecond.
template <class Word>
struct Ticks {
    struct Tick {
        Word ctrl, cycles, count;
    } processor[2], timer[2], watchdog, riscv;
};
static_assert(offsetof(Ticks<DeviceWord>, watchdog) == 0x30);

// 12.9: watchdog.
template <class Word>
struct Watchdog {
    Word ctrl, load, reason, scratch[8];
};

// 6.4: of the power manager, why the chip was reset.
template <class Word>
struct PowerManager {
    Word reserved_00[11], chip_reset;
};
static_assert(offsetof(PowerManager<DeviceWord>, chip_reset) == 0x2C);

// 9.11: what each pin belongs to, and its pad.
template <class Word>
struct PinFunctions {
    struct Pin {
        Word status, ctrl;
    } pin[kPinCount];
};
template <class Word>
struct Pads {
    Word voltage, pin[kPinCount];
};

// 3.1: levels of pins by the core.
template <class Word>
struct CorePins {
    Word cpuid, in, in_high, reserved_0c, out, out_high, out_set, out_high_set, out_clear,
        out_high_clear, out_flip, out_high_flip, enable, enable_high, enable_set, enable_high_set,
        enable_clear;
};
static_assert(offsetof(CorePins<DeviceWord>, out_clear) == 0x20);
static_assert(offsetof(CorePins<DeviceWord>, enable_set) == 0x38);

// 12.6: DMA. A channel has its four registers in four orders; the last of each starts it.
template <class Word>
struct DmaChannel {
    Word read_addr, write_addr, count, ctrl_start;
    Word ctrl, read_addr_1, write_addr_1, count_start;
    Word ctrl_2, count_2, read_addr_2, write_addr_start;
    Word ctrl_3, write_addr_3, count_3, read_addr_start;
};
template <class Word>
struct Dma {
    DmaChannel<Word> channel[16];
    Word raised, enabled_0, forced_0, pending_0, reserved_410[21], abort;
};
static_assert(sizeof(DmaChannel<DeviceWord>) == 0x40);
static_assert(offsetof(Dma<DeviceWord>, pending_0) == 0x40C);
static_assert(offsetof(Dma<DeviceWord>, abort) == 0x464);

// 11.7: programmable I/O.
template <class Word>
struct StateMachine {
    Word clkdiv, execctrl, shiftctrl, addr, instr, pinctrl;
};
template <class Word>
struct Pio {
    Word ctrl, fstat, fdebug, flevel, txf[4], rxf[4], irq, irq_force, input_sync, padout, padoe,
        cfginfo;
    Word instr_mem[32];
    StateMachine<Word> machine[4];
};
static_assert(offsetof(Pio<DeviceWord>, instr_mem) == 0x48);
static_assert(offsetof(Pio<DeviceWord>, machine) == 0xC8);

// 12.5: pulse width modulation.
template <class Word>
struct Pwm {
    struct Slice {
        Word csr, div, ctr, cc, top;
    } slice[12];
};

// 12.1: serial port.
template <class Word>
struct Uart {
    Word dr, rsr, reserved_08[4], fr, reserved_1c, ilpr, ibrd, fbrd, lcr_h, cr, ifls, imsc, ris,
        mis, icr, dmacr;
};
static_assert(offsetof(Uart<DeviceWord>, fr) == 0x18);
static_assert(offsetof(Uart<DeviceWord>, imsc) == 0x38);

// 12.7: USB device; its memory of 4 KB, and its registers.
template <class Word>
struct UsbMemory {
    Word setup[2], control[30];  // of IN and OUT of endpoints 1 to 15
    Word buffer[32];             // controls of the buffers: IN and OUT of endpoints 0 to 15
    Word data[960];
};
static_assert(offsetof(UsbMemory<DeviceWord>, buffer) == 0x80);
static_assert(sizeof(UsbMemory<DeviceWord>) == 0x1000);
template <class Word>
struct Usb {
    Word addr_endp[16], main_ctrl, sof_wr, sof_rd, sie_ctrl, sie_status, int_ep_ctrl, buff_status;
    Word buff_cpu, ep_abort, ep_abort_done, ep_stall_arm, nak_poll, ep_stall_nak, muxing, pwr;
    Word phy_direct, phy_override, phy_trim, reserved_88, intr, inte, intf, ints;
};
static_assert(offsetof(Usb<DeviceWord>, ep_abort) == 0x60);
static_assert(offsetof(Usb<DeviceWord>, muxing) == 0x74);
static_assert(offsetof(Usb<DeviceWord>, ints) == 0x98);

}  // namespace cusp::hal::rp2350
