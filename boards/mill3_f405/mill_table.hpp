// MillTable: the 3-axis mill controller with an STM32F405 at 168 MHz. README.md is its wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/panel_pins.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/spindle_wire.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {

struct MillTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'C', 0}, {'C', 1}, {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}}};
    static constexpr PanelPins kPanelPins = [] {
        PanelPins pins;
        pins.limit_x = {'B', 12};
        pins.limit_y = {'B', 13};
        pins.limit_z = {'B', 14};
        pins.probe = {'B', 15};
        pins.door = {'B', 8};
        pins.hold = {'B', 9};
        pins.start = {'B', 6};
        pins.reset = {'B', 7};
        pins.emergency_stop = {'B', 10};
        pins.motor_fault = {'B', 11};
        pins.at_speed = {'B', 5};
        pins.drives_off = {{{'C', 6}}};
        pins.flood = {'C', 7};
        pins.mist = {'C', 8};
        pins.spindle_on = {'A', 5};
        pins.spindle_reverse = {'A', 7};
        pins.spindle_pulses = {{'A', 6}, 1};
        return pins;
    }();

    // RS-485, to a spindle's drive.
    static constexpr hal::stm32f4::SpindleWirePins kSpindleWire{{'A', 2}, {'A', 3}, {'A', 1}};
    template <class Chip>
    using SpindlePort = hal::stm32f4::Usart2Port<Chip>;

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart1Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 1};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp mill3_f405"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kNotSensed;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
