// MillTraits: the 3-axis mill controller with an STM32F405 at 168 MHz.
#pragma once

#include <cstdint>

#include "boards/mill3/chip_start.hpp"
#include "boards/mill3_f405/mill_pins.hpp"
#include "hal/stm32f4/dma_link.hpp"
#include "hal/stm32f4/dma_pulse_player.hpp"
#include "hal/stm32f4/flash_settings.hpp"

namespace cusp::boards {

struct MillTraits : ChipStart<MillTraits> {
    using StepPort = MillStepPort<Chip>;
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    using PulsePlayer = hal::stm32f4::DmaPulsePlayer<Chip, StepPort, Pace>;
    using ByteLink = hal::stm32f4::DmaLink<Chip>;
    using Panel = MillPanel<Chip, MillTraits>;
    using SettingsStore = hal::stm32f4::FlashSettings<Chip>;

    static constexpr bool kSpindleTimer = true;
    static constexpr const PanelPins& kPanelPins = kMillPins;
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 1};
    static constexpr std::uint32_t kSpindleTimerHz = kClocks.slow_timer_hz();
    static constexpr std::uint32_t kBaud = 115200;
};

}  // namespace cusp::boards
