// Skr2Table: BIGTREETECH's SKR 2 with an STM32F407. Its lines lie on ports E, D and A. README.md is
// the wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/mill_panel.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {

struct Skr2Table {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'E', 2}, {'D', 5}, {'A', 15}, {'E', 1}, {'D', 4}, {'A', 8}, {'D', 15}, {'D', 14}}};
    static constexpr PanelPins kPanelPins{
        {{{'C', 1}, {'C', 3}, {'C', 0}, {'E', 4}}},
        {{{'A', 7}, {'A', 5}, {'A', 6}, {'A', 4}}},
        {{{'C', 2}, {'A', 0}}},
        {{{'E', 3}, {'D', 6}, {'D', 1}, {'C', 7}}},
        {'B', 3},
        {'B', 4},
        {'B', 6},
        {'B', 5},
        {{'B', 0}, 3},
        {'C', 13},
        {'E', 7},
    };

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart1Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 1};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp skr2_f407"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kNotSensed;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
