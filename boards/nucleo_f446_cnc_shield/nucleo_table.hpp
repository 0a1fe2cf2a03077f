// NucleoTable: a Nucleo-F446RE with a CNC shield: the pins of Grbl 1.1 on an Arduino Uno, by the
// names that UM1724 gives the headers. README.md is the wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/mill_panel.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"

namespace cusp::boards {

struct NucleoTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'A', 10}, {'B', 3}, {'B', 5}, {'B', 4}, {'B', 10}, {'A', 8}}};
    static constexpr PanelPins kPanelPins{
        {{{'C', 7}, {'B', 6}, {'A', 6}, {'C', 0}}},
        {{{'C', 8}, {'A', 1}, {'A', 4}, {'A', 0}}},
        {{{'C', 6}, {'C', 5}}},
        {{{'A', 9}}},
        {'B', 0},
        {'C', 1},
        {'B', 7},
        {'A', 5},
        {{'A', 7}, 2},
    };

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart2Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 3, true};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
