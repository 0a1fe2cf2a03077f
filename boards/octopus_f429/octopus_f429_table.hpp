// OctopusF429Table: an Octopus with an STM32F429: the pins of OctopusTable, the regulator's scales of another chip, another crystal.
#pragma once

#include "boards/octopus_f446/octopus_table.hpp"

namespace cusp::boards {

struct OctopusF429Table : OctopusTable {
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 3};
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp octopus_f429"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kNotSensed;
};

}  // namespace cusp::boards
