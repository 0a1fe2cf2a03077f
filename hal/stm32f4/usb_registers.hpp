// The registers of USB OTG FS in device mode, by the names of RM0090 section 34.16 in lower case.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// One endpoint; `txfsts` is there for IN endpoints alone.
template <class Word>
struct UsbEndpoint {
    Word ctl, reserved_04, intr, reserved_0c, tsiz, reserved_14, txfsts, reserved_1c;
};
static_assert(sizeof(UsbEndpoint<DeviceWord>) == 0x20);

template <class Word>
struct UsbCore {
    Word gotgctl, gotgint, gahbcfg, gusbcfg, grstctl, gintsts, gintmsk, grxstsr, grxstsp, grxfsiz;
    Word dieptxf0, hnptxsts, reserved_30[2], gccfg, cid, reserved_40[48];
    Word hptxfsiz, dieptxf[3], reserved_110[444];
    Word dcfg, dctl, dsts, reserved_80c, diepmsk, doepmsk, daint, daintmsk;
    Word reserved_820[2], dvbusdis, dvbuspulse, reserved_830, diepempmsk, reserved_838[50];
    UsbEndpoint<Word> in[4];
    Word reserved_980[96];
    UsbEndpoint<Word> out[4];
    Word reserved_b80[160], pcgcctl, reserved_e04[127];
    // Words written to the n-th are of IN endpoint n; the first, read, gives what was received.
    struct Fifo {
        Word word, reserved[1023];
    } fifo[4];
};
static_assert(offsetof(UsbCore<DeviceWord>, dieptxf0) == 0x28);
static_assert(offsetof(UsbCore<DeviceWord>, gccfg) == 0x38);
static_assert(offsetof(UsbCore<DeviceWord>, dieptxf) == 0x104);
static_assert(offsetof(UsbCore<DeviceWord>, dcfg) == 0x800);
static_assert(offsetof(UsbCore<DeviceWord>, daintmsk) == 0x81C);
static_assert(offsetof(UsbCore<DeviceWord>, in) == 0x900);
static_assert(offsetof(UsbCore<DeviceWord>, out) == 0xB00);
static_assert(offsetof(UsbCore<DeviceWord>, pcgcctl) == 0xE00);
static_assert(offsetof(UsbCore<DeviceWord>, fifo) == 0x1000);

// GINTSTS and GINTMSK.
inline constexpr std::uint32_t kUsbReceived = 1U << 4U;
inline constexpr std::uint32_t kUsbSuspend = 1U << 11U;
inline constexpr std::uint32_t kUsbReset = 1U << 12U;
inline constexpr std::uint32_t kUsbEnumerated = 1U << 13U;
inline constexpr std::uint32_t kUsbInEvent = 1U << 18U;
inline constexpr std::uint32_t kUsbOutEvent = 1U << 19U;
inline constexpr std::uint32_t kUsbWakeUp = 1U << 31U;

// DIEPCTL and DOEPCTL.
inline constexpr std::uint32_t kUsbActive = 1U << 15U;
inline constexpr std::uint32_t kUsbStall = 1U << 21U;
inline constexpr std::uint32_t kUsbClearNak = 1U << 26U;
inline constexpr std::uint32_t kUsbSetNak = 1U << 27U;
inline constexpr std::uint32_t kUsbDataZero = 1U << 28U;  // the next packet is DATA0
inline constexpr std::uint32_t kUsbDisable = 1U << 30U;
inline constexpr std::uint32_t kUsbEnable = 1U << 31U;

// DIEPINT and DOEPINT.
inline constexpr std::uint32_t kUsbTransferDone = 1U << 0U;
inline constexpr std::uint32_t kUsbDisabled = 1U << 1U;
inline constexpr std::uint32_t kUsbSetupDone = 1U << 3U;

}  // namespace cusp::hal::stm32f4
