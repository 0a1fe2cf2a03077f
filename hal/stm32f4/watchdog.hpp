// The independent watchdog, and a restart.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Resets the chip if feed_watchdog() is not called for 3 s (2 to 5.6 s: the chip's slow oscillator
// is coarse). The longest stall of the core is the erase of a settings sector, 0.8 s.
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

// Restarts the chip: everything but the retained memory is as after power-up.
template <class Chip>
[[noreturn]] void reset_chip() noexcept
{
    constexpr std::uint32_t kResetRequest = 0x05FA0004;
    __asm volatile("" ::: "memory");
    Chip::system().aircr.write(kResetRequest);
    for (;;) {
    }
}

}  // namespace cusp::hal::stm32f4
