// PillTable: a small controller with an STM32F411 at 96 MHz, on a board of the kind called Black Pill.
// It has no timer 8, so timer 1 asks for the pulses. At its 100 MHz there would be no 48 MHz for USB.
#pragma once

#include <cstdint>

#include "boards/mill3/panel_pins.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {

struct PillTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'A', 0}, {'A', 1}, {'A', 2}, {'A', 3}, {'A', 4}, {'A', 5}}};
    static constexpr PanelPins kPanelPins = [] {
        PanelPins pins;
        pins.limit_x = {'B', 5};
        pins.limit_y = {'B', 6};
        pins.limit_z = {'B', 7};
        pins.probe = {'B', 8};
        pins.door = {'B', 9};
        pins.hold = {'B', 10};
        pins.start = {'B', 1};
        pins.reset = {'B', 0};
        pins.emergency_stop = {'B', 15};
        pins.motor_fault = {'B', 3};
        pins.drives_off = {{{'B', 12}}};
        pins.flood = {'B', 13};
        pins.mist = {'B', 14};
        pins.spindle_on = {'A', 8};
        pins.spindle_reverse = {'A', 7};
        pins.spindle_pulses = {{'A', 6}, 1};
        return pins;
    }();

    template <class Chip>
    using Pace = hal::stm32f4::Timer1Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart1Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{25000000, 96000000, 3, 1, 2, 3};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp black_pill_f411"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kNotSensed;
    static constexpr std::uint32_t kMostStepsPerSecond = 163000;
};

}  // namespace cusp::boards
