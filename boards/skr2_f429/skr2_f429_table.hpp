// Skr2F429Table: an SKR 2 with an STM32F429: the pins of Skr2Table, the regulator's scales of another chip.
#pragma once

#include "boards/skr2_f407/skr2_table.hpp"

namespace cusp::boards {

struct Skr2F429Table : Skr2Table {
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 3};
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp skr2_f429"};
};

}  // namespace cusp::boards
