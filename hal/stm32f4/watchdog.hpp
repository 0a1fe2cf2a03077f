// The independent watchdog, and a restart.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Resets the chip if feed_watchdog() is not called for 3 s (2 to 5.6 s: the chip's slow oscillator
// is coarse), or longer where the core stalls for longer: `longest_stall_ms` is the erase of a settings
// sector, and at its soonest the watchdog waits half as long again.
template <class Chip>
void start_watchdog(std::uint32_t longest_stall_ms) noexcept
{
    constexpr std::uint32_t kDivideBy256 = 6;
    constexpr std::uint32_t kFastestKhz = 47;
    constexpr std::uint32_t kLeastReload = 375;
    const std::uint32_t outlasts = longest_stall_ms * 3 / 2 * kFastestKhz / 256;
    const std::uint32_t reload = outlasts > kLeastReload ? outlasts : kLeastReload;
    auto& watchdog = Chip::watchdog();
    watchdog.kr.write(0xCCCC);
    watchdog.kr.write(0x5555);
    watchdog.pr.write(kDivideBy256);
    watchdog.rlr.write(reload);
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
