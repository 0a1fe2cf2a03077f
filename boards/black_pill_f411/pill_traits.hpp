// PillTraits: a small 3-axis controller with an STM32F411 at 100 MHz, on a board of the kind called
// Black Pill. It has no timer 8, so timer 1 asks for the pulses.
#pragma once

#include <cstdint>

#include "boards/mill3/chip_start.hpp"
#include "boards/mill3/mill_panel.hpp"
#include "hal/stm32f4/dma_link.hpp"
#include "hal/stm32f4/dma_pulse_player.hpp"
#include "hal/stm32f4/flash_settings.hpp"

namespace cusp::boards {

// The six step and direction lines: pins 0 to 5 of port A.
template <class Chip>
struct PillStepPort {
    static auto& gpio() noexcept { return Chip::port_a(); }
};

inline constexpr PanelPins kPillPins{
    {{{'B', 5}, {'B', 6}, {'B', 7}, {'B', 8}}},
    {{{'B', 9}, {'B', 10}, {'B', 1}, {'B', 0}}},
    {{{'B', 15}, {'B', 3}}},
    {'B', 12},
    {'B', 13},
    {'B', 14},
    {'A', 8},
    {'A', 7},
    {'A', 6},
};

struct PillTraits : ChipStart<PillTraits> {
    using StepPort = PillStepPort<Chip>;
    using Pace = hal::stm32f4::Timer1Pace<Chip>;
    using PulsePlayer = hal::stm32f4::DmaPulsePlayer<Chip, StepPort, Pace>;
    using ByteLink = hal::stm32f4::DmaLink<Chip>;
    using Panel = MillPanel<Chip, PillTraits>;
    using SettingsStore = hal::stm32f4::FlashSettings<Chip>;

    static constexpr bool kSpindleTimer = true;
    static constexpr const PanelPins& kPanelPins = kPillPins;
    static constexpr hal::stm32f4::ClockPlan kClocks{25000000, 100000000, 3, 1, 2, 3};
    static constexpr std::uint32_t kSpindleTimerHz = kClocks.slow_timer_hz();
    static constexpr std::uint32_t kBaud = 115200;
};

}  // namespace cusp::boards
