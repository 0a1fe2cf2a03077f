// The independent watchdog, and the clocks of the blocks that the drivers use.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Resets the chip when feed_watchdog() stays away for 3 s (2 to 5.6 s: the chip's slow oscillator
// is coarse). The longest that the core can be held up is the erasing of a settings sector, 0.8 s.
template <class Chip>
void start_watchdog() noexcept
{
    constexpr std::uint32_t kDivideBy256 = 6;
    constexpr std::uint32_t kReload = 375;
    auto& watchdog = Chip::watchdog();
    watchdog.kr.write(0xCCCC);
    watchdog.kr.write(0x5555);
    watchdog.pr.write(kDivideBy256);
    watchdog.rlr.write(kReload);
}

template <class Chip>
void feed_watchdog() noexcept
{
    Chip::watchdog().kr.write(0xAAAA);
}

// Starts the chip anew: everything but the retained memory is as after power-up.
template <class Chip>
[[noreturn]] void reset_chip() noexcept
{
    constexpr std::uint32_t kResetRequest = 0x05FA0004;
    __asm volatile("" ::: "memory");
    Chip::system().aircr.write(kResetRequest);
    for (;;) {
    }
}

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
