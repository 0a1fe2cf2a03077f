// PinRules: what the compiler finds wrong in a board's table of pins, so that no such board is built.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "boards/mill3/panel_pins.hpp"
#include "boards/mill3/pin_checks.hpp"
#include "hal/stm32f4/drive_bus.hpp"
#include "hal/stm32f4/drive_wire.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/spindle_wire.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {
namespace detail {

template <class Table, class = void>
inline constexpr bool has_usb = false;
template <class Table>
inline constexpr bool has_usb<Table, std::void_t<decltype(Table::kUsb)>> = true;

template <class Table, class = void>
inline constexpr hal::stm32f4::DrivePins drive_pins{};
template <class Table>
inline constexpr hal::stm32f4::DrivePins
    drive_pins<Table, std::void_t<decltype(Table::kDriveWires)>> = Table::kDriveWires;

template <class Table, class = void>
inline constexpr hal::stm32f4::DriveBusPins drive_bus_pins{};
template <class Table>
inline constexpr hal::stm32f4::DriveBusPins
    drive_bus_pins<Table, std::void_t<decltype(Table::kDriveBus)>> = Table::kDriveBus;

template <class Table, class = void>
inline constexpr hal::stm32f4::SpindleWirePins spindle_wire_pins{};
template <class Table>
inline constexpr hal::stm32f4::SpindleWirePins
    spindle_wire_pins<Table, std::void_t<decltype(Table::kSpindleWire)>> = Table::kSpindleWire;

template <class Table, class = void>
inline constexpr float sense_milliohms = 0;
template <class Table>
inline constexpr float sense_milliohms<Table, std::void_t<decltype(Table::kSenseMilliohms)>> =
    Table::kSenseMilliohms;

template <class Table, class = void>
inline constexpr float bus_sense_milliohms = 0;
template <class Table>
inline constexpr float
    bus_sense_milliohms<Table, std::void_t<decltype(Table::kBusSenseMilliohms)>> =
        Table::kBusSenseMilliohms;

constexpr bool exists(Pin pin) noexcept
{
    return pin.port >= 'A' && pin.port <= 'I' && pin.number < 16;
}

// All that a table names, absent ones too, but for the one that drives on a bus answer on.
using AllPins = std::array<Pin, 8 + 12 + 10 + 4 + 2 + 3>;
template <class Table>
constexpr AllPins all_pins() noexcept
{
    AllPins all{};
    std::size_t count = 0;
    for (const Pin pin : Table::kLines) {
        all[count++] = pin;
    }
    for (const Pin pin : input_pins(Table::kPanelPins)) {
        all[count++] = pin;
    }
    for (const Pin pin : output_pins(Table::kPanelPins)) {
        all[count++] = pin;
    }
    for (const Pin pin : drive_pins<Table>) {
        all[count++] = pin;
    }
    for (const Pin pin : {drive_bus_pins<Table>.clock, drive_bus_pins<Table>.to_drives}) {
        all[count++] = pin;
    }
    for (const Pin pin : {spindle_wire_pins<Table>.transmit, spindle_wire_pins<Table>.receive,
                          spindle_wire_pins<Table>.sends}) {
        all[count++] = pin;
    }
    return all;
}

constexpr bool all_exist(const AllPins& all) noexcept
{
    for (const Pin pin : all) {
        if (is_there(pin) && !exists(pin)) {
            return false;
        }
    }
    return true;
}
}  // namespace detail

// `Table` as in boards/mill3/chip_traits.hpp, `SerialPort` its port, `Pace` its pace. kHold is true, or nothing compiles.
template <class Table, class SerialPort, class Pace>
struct PinRules {
    static constexpr detail::AllPins kAll = detail::all_pins<Table>();

    static_assert(detail::all_exist(kAll), "a pin is none of A0 to I15");
    static_assert(detail::is_complete(Table::kLines, Table::kPanelPins),
                  "a line, input or output has no pin");
    static_assert(!detail::names_one_twice(kAll), "a pin is named twice");
    static_assert(!detail::names_one(kAll, {'A', 13}) && !detail::names_one(kAll, {'A', 14}),
                  "PA13 and PA14 are the debugger's");
    static_assert(!detail::names_one(kAll, {'H', 0}) && !detail::names_one(kAll, {'H', 1}),
                  "PH0 and PH1 are the crystal's");
    static_assert(!detail::names_one(kAll, SerialPort::kTransmit) &&
                      !detail::names_one(kAll, SerialPort::kReceive),
                  "a pin is the serial port's");
    static_assert(!detail::has_usb<Table> || (!detail::names_one(kAll, hal::stm32f4::kUsbMinus) &&
                                              !detail::names_one(kAll, hal::stm32f4::kUsbPlus)),
                  "PA11 and PA12 are the USB plug's");
    static_assert(hal::stm32f4::has_channel(Table::kPanelPins.spindle_pulses),
                  "the pin of the spindle's pulses does not have that channel of that timer");
    static_assert(Table::kPanelPins.spindle_pulses.timer != Pace::kTimer,
                  "the timer of the spindle's pulses asks for the step pulses");
    static_assert(hal::stm32f4::drive_wires(detail::drive_pins<Table>) == 0 ||
                      (Pace::kTimer != 1 && Table::kPanelPins.spindle_pulses.timer != 1),
                  "timer 1 is that of the drives' wires");
    static_assert(!detail::names_one(kAll, detail::drive_bus_pins<Table>.from_drives),
                  "the pin that drives answer on is named twice");
    static_assert(is_there(detail::drive_bus_pins<Table>.clock) ==
                          is_there(detail::drive_bus_pins<Table>.to_drives) &&
                      is_there(detail::drive_bus_pins<Table>.clock) ==
                          is_there(detail::drive_bus_pins<Table>.from_drives),
                  "the drives' bus lacks a pin");
    static_assert(!is_there(detail::drive_bus_pins<Table>.clock) ||
                      hal::stm32f4::drive_wires(detail::drive_pins<Table>) != 0,
                  "the drives' bus has no select lines");
    static_assert(is_there(detail::spindle_wire_pins<Table>.transmit) ==
                          is_there(detail::spindle_wire_pins<Table>.receive) &&
                      is_there(detail::spindle_wire_pins<Table>.transmit) ==
                          is_there(detail::spindle_wire_pins<Table>.sends),
                  "the spindle's line lacks a pin");
    static_assert(is_there(Table::kLines[6]) == is_there(Table::kLines[7]),
                  "the second motor has a step without a direction, or the other way round");

    static constexpr bool kHold = true;
};

}  // namespace cusp::boards
