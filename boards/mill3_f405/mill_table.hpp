// MillTable: the 3-axis mill controller with an STM32F405 at 168 MHz. README.md is its wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/mill_panel.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {

struct MillTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'C', 0}, {'C', 1}, {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}}};
    static constexpr PanelPins kPanelPins{
        {{{'B', 12}, {'B', 13}, {'B', 14}, {'B', 15}}},
        {{{'B', 8}, {'B', 9}, {'B', 6}, {'B', 7}}},
        {{{'B', 10}, {'B', 11}}},
        {{{'C', 6}}},
        {'C', 7},
        {'C', 8},
        {'A', 5},
        {'A', 7},
        {{'A', 6}, 1},
    };

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
