// PeripheralClocks: the clocks of the blocks that the drivers use.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Bits of RCC_AHB1ENR, RCC_APB1ENR and RCC_APB2ENR: blocks that are to have a clock.
struct PeripheralClocks {
    std::uint32_t ahb1;
    std::uint32_t apb1;
    std::uint32_t apb2;
};
constexpr PeripheralClocks operator|(PeripheralClocks a, PeripheralClocks b) noexcept
{
    return {a.ahb1 | b.ahb1, a.apb1 | b.apb1, a.apb2 | b.apb2};
}

template <class Chip>
void start_peripherals(PeripheralClocks clocks) noexcept
{
    auto& rcc = Chip::rcc();
    set_bits(rcc.ahb1enr, clocks.ahb1);
    set_bits(rcc.apb1enr, clocks.apb1);
    set_bits(rcc.apb2enr, clocks.apb2);
    // The clock arrives two bus cycles after the bit is set.
    static_cast<void>(rcc.apb2enr.read());
    static_cast<void>(rcc.apb2enr.read());
}

}  // namespace cusp::hal::stm32f4
