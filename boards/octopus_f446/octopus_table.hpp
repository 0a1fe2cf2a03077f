// OctopusTable: BIGTREETECH's Octopus with an STM32F446. Its lines lie on ports F and G. README.md is
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

struct OctopusTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'F', 13}, {'G', 0}, {'F', 11}, {'F', 12}, {'G', 1}, {'G', 3}, {'F', 9}, {'F', 10}}};
    static constexpr PanelPins kPanelPins{
        {{{'G', 6}, {'G', 9}, {'G', 10}, {'B', 7}}},
        {{{'G', 14}, {'E', 8}, {'E', 7}, {'G', 15}}},
        {{{'G', 12}, {'G', 13}}},
        {{{'F', 14}, {'F', 15}, {'G', 5}, {'G', 2}}},
        {'A', 2},
        {'A', 3},
        {'A', 8},
        {'E', 5},
        {{'A', 6}, 1},
        {},
        {'G', 11},
    };

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart1Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{12000000, 168000000, 5, 2, 4, 3};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp octopus_f446"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kOverridden;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
