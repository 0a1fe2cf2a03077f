// A board that nobody has: lines on two ports, another serial port, a 12 MHz crystal, no USB.
#pragma once

#include "boards/mill3/panel_pins.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"

namespace cusp::boards {

struct MadeUpTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'B', 1}, {'E', 9}, {'B', 12}, {'E', 3}, {'B', 2}, {'E', 14}}};
    static constexpr PanelPins kPanelPins = [] {
        PanelPins pins;
        pins.limit_x = {'D', 0};
        pins.limit_y = {'C', 13};
        pins.limit_z = {'D', 2};
        pins.probe = {'C', 4};
        pins.door = {'E', 0};
        pins.hold = {'D', 5};
        pins.start = {'C', 1};
        pins.reset = {'D', 7};
        pins.emergency_stop = {'A', 0};
        pins.motor_fault = {'D', 9};
        pins.drives_off = {{{'C', 10}, {'C', 11}, {'C', 12}}};
        pins.flood = {'D', 14};
        pins.mist = {'B', 6};
        pins.spindle_on = {'A', 10};
        pins.spindle_reverse = {'A', 11};
        pins.spindle_pulses = {{'B', 4}, 1};
        return pins;
    }();

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart2Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{12000000, 168000000, 5, 2, 4, 1};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr std::uint32_t kMostStepsPerSecond = 200000;
};

}  // namespace cusp::boards
