// NucleoTable: a Nucleo-F446RE with a CNC shield: the pins of Grbl 1.1 on an Arduino Uno, by the
// names that UM1724 gives the headers. README.md is the wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/panel_pins.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"

namespace cusp::boards {

struct NucleoTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'A', 10}, {'B', 3}, {'B', 5}, {'B', 4}, {'B', 10}, {'A', 8}}};
    static constexpr PanelPins kPanelPins = [] {
        PanelPins pins;
        pins.limit_x = {'C', 7};
        pins.limit_y = {'B', 6};
        pins.limit_z = {'A', 6};
        pins.probe = {'C', 0};
        pins.door = {'C', 8};
        pins.hold = {'A', 1};
        pins.start = {'A', 4};
        pins.reset = {'A', 0};
        pins.emergency_stop = {'C', 6};
        pins.motor_fault = {'C', 5};
        pins.drives_off = {{{'A', 9}}};
        pins.flood = {'B', 0};
        pins.mist = {'C', 1};
        pins.spindle_on = {'B', 7};
        pins.spindle_reverse = {'A', 5};
        pins.spindle_pulses = {{'A', 7}, 2};
        return pins;
    }();

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart2Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 3, true};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
