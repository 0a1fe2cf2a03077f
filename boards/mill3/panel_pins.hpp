// PanelPins: the panel of a board with a chip of the STM32F4 family.
#pragma once

#include <cstdint>

#include "boards/mill3/mill_panel.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/spindle_pulses.hpp"

namespace cusp::boards {

using hal::stm32f4::clock_bit;
using hal::stm32f4::Pin;

using PanelPins = PanelPinsOf<Pin, hal::stm32f4::PulsePin>;

constexpr std::uint32_t clock_bits(const PanelPins& pins) noexcept
{
    std::uint32_t bits = 0;
    for (const Pin pin : input_pins(pins)) {
        bits |= clock_bit(pin);
    }
    for (const Pin pin : output_pins(pins)) {
        bits |= clock_bit(pin);
    }
    return bits;
}

}  // namespace cusp::boards
