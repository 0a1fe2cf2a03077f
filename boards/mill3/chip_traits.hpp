// ChipTraits: a mill controller with a chip of the STM32F4 family, made of the table of its board.
//
// A board's table, such as boards/skr2_f407/skr2_table.hpp, defines:
//   kLines              pins of the step and direction lines, on up to three ports
//   kPanelPins          pins of inputs, spindle, coolant and drives
//   Pace                hal/stm32f4/pace.hpp: which timer asks for the pulses
//   SerialPort          hal/stm32f4/serial_ports.hpp: which USART is the line
//   kClocks             crystal and rates
//   kBaud               of the line
//   kUsb, kUsbSession   hal/usb_serial/usb_descriptors.hpp, hal/stm32f4/usb_endpoints.hpp: of a plug on PA11 and PA12; a
//                       board without has neither
//   kDriveWires, kSenseMilliohms   hal/stm32f4/drive_wire.hpp: of TMC2209 drives that are set by UART, and
//                       their sense resistors; a board without has neither
//   kDriveBus, kBusSenseMilliohms   hal/stm32f4/drive_bus.hpp: of TMC5160 drives in the same sockets, and their
//                       sense resistors; a board without has neither
//   kSpindleWire, SpindlePort   hal/stm32f4/spindle_wire.hpp: of an RS-485 transceiver for a spindle's drive, and
//                       the USART that it hangs on; a board without has neither
//   Settings            hal/stm32f4/flash_settings.hpp: where they are kept; without it, behind the vectors
//   kMostStepsPerSecond of each axis while all three move: what the core has time for
//
// The traits type of a board defines its parts (Chip, PulsePlayer, ByteLink, Panel,
// SettingsStore); start(board), called before the application exists; run(board, application), the
// main loop; and stop(), the end after a fault.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "boards/mill3/main_loop.hpp"
#include "boards/mill3/panel_pins.hpp"
#include "boards/mill3/pin_rules.hpp"
#include "boards/mill3/two_links.hpp"
#include "firmware/machine/accessories.hpp"
#include "firmware/machine/stored_state.hpp"
#include "hal/cortex_m/vectors.hpp"
#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/dma_link.hpp"
#include "hal/stm32f4/dma_pulse_player.hpp"
#include "hal/stm32f4/drive_bus.hpp"
#include "hal/stm32f4/drive_wire.hpp"
#include "hal/stm32f4/flash_settings.hpp"
#include "hal/stm32f4/peripheral_clocks.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/reset_reason.hpp"
#include "hal/stm32f4/spindle_wire.hpp"
#include "hal/stm32f4/usb_link.hpp"
#include "hal/stm32f4/watchdog.hpp"

namespace cusp::boards {
namespace detail {

// A table without a spindle's line has that of no port.
struct NoSpindleWire {
    static constexpr unsigned kInterrupt = 0;
    static constexpr bool kOnFastBus = false;
    static constexpr hal::stm32f4::PeripheralClocks kClocks{0, 0, 0};
};
template <class Table, class = void>
struct SpindleLineOf {
    template <class Chip>
    using Port = NoSpindleWire;
};
template <class Table>
struct SpindleLineOf<Table, std::void_t<decltype(Table::kSpindleWire)>> {
    template <class Chip>
    using Port = typename Table::template SpindlePort<Chip>;
};

template <class Table, class = void>
struct SettingsOf {
    using Place = hal::stm32f4::SettingsBehindVectors;
};
template <class Table>
struct SettingsOf<Table, std::void_t<typename Table::Settings>> {
    using Place = typename Table::Settings;
};

}  // namespace detail

template <class Table>
struct ChipTraits {
    using Chip = hal::stm32f4::Chip;
    using Pace = typename Table::template Pace<Chip>;
    using SerialPort = typename Table::template SerialPort<Chip>;
    using PulsePlayer = hal::stm32f4::DmaPulsePlayer<Chip, Table, Pace>;
    using SerialLink = hal::stm32f4::DmaLink<Chip, SerialPort>;
    static constexpr bool kUsb = detail::has_usb<Table>;
    using ByteLink = std::
        conditional_t<kUsb, TwoLinks<SerialLink, hal::stm32f4::UsbLink<Chip, Table>>, SerialLink>;
    using Panel = MillPanel<ChipTraits>;
    using SettingsPlace = typename detail::SettingsOf<Table>::Place;
    static constexpr hal::stm32f4::SettingsPlace kSettings = SettingsPlace::kPlace;
    using SettingsStore = hal::stm32f4::FlashSettings<Chip, SettingsPlace>;

    static_assert(PinRules<Table, SerialPort, Pace>::kHold);
    // start_clocks() sets no others.
    static_assert(Table::kClocks.fast_bus_divisor == 1 || Table::kClocks.fast_bus_divisor == 2);
    static_assert(Table::kClocks.slow_bus_divisor == 2 || Table::kClocks.slow_bus_divisor == 4);
    static_assert(!kUsb || Table::kClocks.has_usb(), "no 48 MHz from this core_hz");

    // The drives' part of MillBoard needs these.
    static constexpr const hal::stm32f4::DrivePins& kDrivePins = detail::drive_pins<Table>;
    static constexpr std::uint8_t kDriveWires = hal::stm32f4::drive_wires(kDrivePins);
    static constexpr float kSenseMilliohms = detail::sense_milliohms<Table>;
    using DriveWire = hal::stm32f4::DriveWire<Chip, Table>;
    static constexpr bool kDriveBus = is_there(detail::drive_bus_pins<Table>.clock);
    static constexpr float kBusSenseMilliohms = detail::bus_sense_milliohms<Table>;
    using DriveBus = hal::stm32f4::DriveBus<Chip, Table>;

    // The spindle's.
    static constexpr const hal::stm32f4::SpindleWirePins& kSpindlePins =
        detail::spindle_wire_pins<Table>;
    static constexpr bool kSpindleWire = is_there(kSpindlePins.transmit);
    using SpindlePort = typename detail::SpindleLineOf<Table>::template Port<Chip>;
    using SpindleWire = hal::stm32f4::SpindleWire<Chip, SpindlePort, Table>;

    // Members that MillPanel needs.
    using Pins = hal::stm32f4::PinAccess<Chip>;
    using SpindlePulses = hal::stm32f4::SpindlePulses<Chip, ChipTraits>;
    static constexpr bool kSpindleTimer = true;
    static constexpr const PanelPins& kPanelPins = Table::kPanelPins;
    static constexpr const hal::stm32f4::PulsePin& kPulses = kPanelPins.spindle_pulses;
    static constexpr std::uint32_t kFastTimerHz = Table::kClocks.fast_timer_hz();
    static constexpr std::uint32_t kSlowTimerHz = Table::kClocks.slow_timer_hz();

    static constexpr std::uint32_t kMostStepsPerSecond = Table::kMostStepsPerSecond;
    static constexpr bool kSecondMotor = hal::stm32f4::has_second_motor(Table::kLines);
    static constexpr bool kAtSpeedInput = is_there(kPanelPins.at_speed);

    // True if the end of a frame calls for the servo tick.
    static constexpr bool live() noexcept { return true; }
    static constexpr unsigned player_interrupt() noexcept
    {
        return hal::stm32f4::dma2_interrupt(Pace::kRequests[0].stream);
    }
    static constexpr unsigned serial_interrupt() noexcept { return SerialPort::kInterrupt; }
    static constexpr unsigned send_interrupt() noexcept { return SerialPort::kSendInterrupt; }
    // The serial port's where there are no wires.
    static constexpr unsigned drive_interrupt() noexcept
    {
        return kDriveWires != 0 ? DriveWire::kInterrupt : serial_interrupt();
    }

    static constexpr unsigned spindle_interrupt() noexcept
    {
        return kSpindleWire ? SpindlePort::kInterrupt : serial_interrupt();
    }

    static constexpr unsigned kInterruptCount = hal::stm32f4::kInterruptCount;
    static constexpr std::array<hal::cortex_m::InterruptEntry, 6> interrupts() noexcept
    {
        return {{{player_interrupt(), cusp_player_interrupt},
                 {serial_interrupt(), cusp_serial_interrupt},
                 {send_interrupt(), cusp_serial_interrupt},
                 {drive_interrupt(), cusp_serial_interrupt},
                 {spindle_interrupt(), cusp_serial_interrupt},
                 {hal::stm32f4::kUsbInterrupt, kUsb ? cusp_usb_interrupt : cusp_exception}}};
    }

    // Outputs and lines at rest, as the settings invert them; left as they are where the store holds
    // something that can't be read. Context: before statics have their values.
    static void rest() noexcept
    {
        // For tests/checks/image.py.
        __asm volatile(
            ".global cusp_settings, cusp_settings_sector\n"
            ".set cusp_settings, %c0\n"
            ".set cusp_settings_sector, %c1" ::"i"(kSettings.address),
            "i"(kSettings.sector_bytes));
        SettingsStore store;
        if (const auto settings = machine::glimpse_settings(store)) {
            const OutputLevels off = machine::output_levels({}, 100, {}, *settings);
            hal::stm32f4::start_peripherals<Chip>({clocks_of_ports(), 0, 0});
            Panel::rest(off);
            PulsePlayer::rest(off.inverted_lines);
            rest_drives();
        }
    }

    template <class Board>
    static void start(Board& board) noexcept
    {
        using namespace hal::stm32f4;
        note_reset_cause<Chip>();
        clock_source_ = start_clocks<Chip>(Table::kClocks);
        if (clock_source_ == ClockSource::kNone) {
            fault("the clock did not start", __FILE__, __LINE__);
        }
        start_peripherals<Chip>(peripheral_clocks());
        Panel::start();
        constexpr unsigned kUsartOnPin = 7;
        for (const Pin pin : {SerialPort::kTransmit, SerialPort::kReceive}) {
            set_pin_function(Chip::port(pin.port), pin.number, kUsartOnPin);
        }
        enable_interrupt<Chip>(serial_interrupt(), kSerialPriority);
        enable_interrupt<Chip>(send_interrupt(), kSerialPriority);
        serial_link(board).start(
            SerialPort::kOnFastBus ? Table::kClocks.fast_bus_hz() : Table::kClocks.slow_bus_hz(),
            Table::kBaud);
        rest_drives();
        if constexpr (kDriveWires != 0) {
            board.drive_wire.start(kFastTimerHz);
            enable_interrupt<Chip>(drive_interrupt(), kSerialPriority);
        }
        if constexpr (kSpindleWire) {
            for (const Pin pin : {kSpindlePins.transmit, kSpindlePins.receive}) {
                set_pin_function(Chip::port(pin.port), pin.number, kUsartOnPin);
            }
            board.spindle_wire.start(SpindlePort::kOnFastBus ? Table::kClocks.fast_bus_hz()
                                                             : Table::kClocks.slow_bus_hz());
            enable_interrupt<Chip>(spindle_interrupt(), kSerialPriority);
        }
        if constexpr (kUsb) {
            // The chip's own oscillator is not accurate enough for it.
            if (clock_source_ == ClockSource::kCrystal) {
                start_usb(board.byte_link.usb);
            }
        }
        set_field(Chip::system().shpr3, 16, 8, kServoTickPriority);
    }

    // After a fault: switches off everything that moves, then restarts, which reports the reason.
    [[noreturn]] static void stop() noexcept
    {
        PulsePlayer::stop();
        Panel::switch_everything_off();
        hal::stm32f4::reset_chip<Chip>();
    }

    // After each servo tick: records whether a reset would lose the position.
    template <class Board>
    static void after_tick(const Board& board) noexcept
    {
        hal::stm32f4::mark_motion(board.pulse_player.moving());
    }

    template <class Board, class Application>
    [[noreturn]] static void run(Board& board, Application& application) noexcept
    {
        using namespace hal::stm32f4;
        report_reset(board.byte_link, clock_source_);
        if constexpr (kUsb) {
            if (clock_source_ == ClockSource::kCrystal) {
                board.byte_link.usb.connect();
            }
        }
        enable_interrupt<Chip>(player_interrupt(), kPlayerPriority);
        board.pulse_player.start(Table::kClocks.fast_timer_hz(), Table::kClocks.slow_timer_hz(),
                                 reset_amid_motion());
        start_watchdog<Chip>(kSettings.longest_erase_ms);
        run_fed<feed_watchdog<Chip>>(application);
    }

private:
    static void rest_drives() noexcept
    {
        if constexpr (kDriveWires != 0) {
            DriveWire::rest();
        }
        if constexpr (kDriveBus) {
            DriveBus::rest();
        }
    }
    template <class Board>
    static SerialLink& serial_link(Board& board) noexcept
    {
        if constexpr (kUsb) {
            return board.byte_link.serial;
        } else {
            return board.byte_link;
        }
    }
    template <class Usb>
    static void start_usb(Usb& usb) noexcept
    {
        using namespace hal::stm32f4;
        constexpr unsigned kUsbOnPin = 10;
        constexpr std::uint32_t kUsbClock = 1U << 7U;
        set_bits(Chip::rcc().ahb2enr, kUsbClock);
        static_cast<void>(Chip::rcc().ahb2enr.read());
        for (const unsigned pin : {kUsbMinus.number, kUsbPlus.number}) {
            set_pin_function(Chip::port(kUsbMinus.port), pin, kUsbOnPin, Pull::kNone);
        }
        usb.start(Table::kUsbSession);
        enable_interrupt<Chip>(kUsbInterrupt, kUsbPriority);
    }
    static constexpr std::uint32_t clocks_of_ports() noexcept
    {
        std::uint32_t ports = clock_bits(kPanelPins) | clock_bit(SerialPort::kTransmit) |
                              clock_bit(SerialPort::kReceive);
        for (const Pin pin : Table::kLines) {
            ports |= clock_bit(pin);
        }
        for (const Pin pin : kDrivePins) {
            ports |= clock_bit(pin);
        }
        const hal::stm32f4::DriveBusPins& bus = detail::drive_bus_pins<Table>;
        for (const Pin pin : {bus.clock, bus.to_drives, bus.from_drives}) {
            ports |= clock_bit(pin);
        }
        for (const Pin pin : {kSpindlePins.transmit, kSpindlePins.receive, kSpindlePins.sends}) {
            ports |= clock_bit(pin);
        }
        return ports;
    }
    static constexpr hal::stm32f4::PeripheralClocks clocks_of_drives() noexcept
    {
        return kDriveWires != 0 ? DriveWire::kClocks : hal::stm32f4::PeripheralClocks{0, 0, 0};
    }
    // Beside those of the serial line: the ports, DMA2, timer 2, PWR, the pace's and the spindle's timer.
    static constexpr hal::stm32f4::PeripheralClocks peripheral_clocks() noexcept
    {
        return hal::stm32f4::PeripheralClocks{clocks_of_ports() | 1U << 22U, 1U << 0U | 1U << 28U,
                                              1U << Pace::kClockBit} |
               clocks_of(kPulses) | SerialPort::kClocks | clocks_of_drives() | SpindlePort::kClocks;
    }

    static inline hal::stm32f4::ClockSource clock_source_{hal::stm32f4::ClockSource::kNone};
};

}  // namespace cusp::boards
