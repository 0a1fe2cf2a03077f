// The registers of the STM32F405 that this firmware touches, by the names of the reference manual
// (RM0090, revision 19), in lower case. A comment names the section of each block.
//
// Each block is a template over its word type: DeviceWord on the chip; in the tests a word that
// reports each access to a model of the chip (tests/unit/hal_stm32f4).
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/cortex_m/cortex_m.hpp"

namespace cusp::hal::stm32f4 {

using namespace cortex_m;

// Section 7.3: reset and clock control.
template <class Word>
struct Rcc {
    Word cr, pllcfgr, cfgr, cir;
    Word ahb1rstr, ahb2rstr, ahb3rstr, reserved_1c;
    Word apb1rstr, apb2rstr, reserved_28, reserved_2c;
    Word ahb1enr, ahb2enr, ahb3enr, reserved_3c;
    Word apb1enr, apb2enr, reserved_48, reserved_4c;
    Word reserved_50[8];
    Word bdcr, csr;
};
static_assert(offsetof(Rcc<DeviceWord>, ahb1enr) == 0x30);
static_assert(offsetof(Rcc<DeviceWord>, apb1enr) == 0x40);
static_assert(offsetof(Rcc<DeviceWord>, apb2enr) == 0x44);
static_assert(offsetof(Rcc<DeviceWord>, csr) == 0x74);

// Section 3.9: flash interface.
template <class Word>
struct Flash {
    Word acr, keyr, optkeyr, sr, cr, optcr;
};
static_assert(offsetof(Flash<DeviceWord>, cr) == 0x10);

// Section 5.4: power control.
template <class Word>
struct Power {
    Word cr, csr;
};

// Section 8.4: general-purpose I/O.
template <class Word>
struct Gpio {
    Word moder, otyper, ospeedr, pupdr, idr, odr, bsrr, lckr, afrl, afrh;
};
static_assert(offsetof(Gpio<DeviceWord>, idr) == 0x10);
static_assert(offsetof(Gpio<DeviceWord>, bsrr) == 0x18);
static_assert(offsetof(Gpio<DeviceWord>, afrh) == 0x24);

// Section 10.5: DMA controller; one stream, and the whole controller.
template <class Word>
struct DmaStream {
    Word cr, ndtr, par, m0ar, m1ar, fcr;
};
static_assert(sizeof(DmaStream<DeviceWord>) == 0x18);

template <class Word>
struct Dma {
    Word lisr, hisr, lifcr, hifcr;
    DmaStream<Word> stream[8];
};
static_assert(offsetof(Dma<DeviceWord>, stream) == 0x10);
static_assert(sizeof(Dma<DeviceWord>) == 0xD0);

// Sections 17.4 and 18.4: advanced-control and general-purpose timers.
template <class Word>
struct Timer {
    Word cr1, cr2, smcr, dier, sr, egr, ccmr1, ccmr2, ccer, cnt, psc, arr, rcr;
    Word ccr1, ccr2, ccr3, ccr4, bdtr, dcr, dmar, option;
};
static_assert(offsetof(Timer<DeviceWord>, dier) == 0x0C);
static_assert(offsetof(Timer<DeviceWord>, egr) == 0x14);
static_assert(offsetof(Timer<DeviceWord>, arr) == 0x2C);
static_assert(offsetof(Timer<DeviceWord>, ccr1) == 0x34);
static_assert(offsetof(Timer<DeviceWord>, bdtr) == 0x44);
static_assert(offsetof(Timer<DeviceWord>, option) == 0x50);

// Section 30.6: serial port.
template <class Word>
struct Usart {
    Word sr, dr, brr, cr1, cr2, cr3, gtpr;
};
static_assert(offsetof(Usart<DeviceWord>, cr1) == 0x0C);

// Section 21.4: independent watchdog.
template <class Word>
struct Watchdog {
    Word kr, pr, rlr, sr;
};

// Section 38.16: what stops while a debugger holds the core.
template <class Word>
struct Debug {
    Word idcode, cr, apb1_freeze, apb2_freeze;
};

}  // namespace cusp::hal::stm32f4
