// The watchdog, and a restart.
#pragma once

#include <cstdint>

#include "hal/rp2350/chip_registers.hpp"

namespace cusp::hal::rp2350 {
namespace detail {

inline constexpr std::uint32_t kWatchdogMicroseconds = 3000000;

// In the first scratch word, which only a reset of the whole chip clears: the boot ROM restarts the chip by its watchdog,
// too, after it has written the flash.
inline constexpr std::uint32_t kOurWatchdog = 0x43555350;

// Everything but both oscillators: what a watchdog does not reset stays as it was (7.4).
template <class Chip>
void prepare_reset() noexcept
{
    Chip::watchdog().scratch[0].write(kOurWatchdog);
    constexpr std::uint32_t kAll = 0x01FFFFFF;
    constexpr std::uint32_t kOscillators = 1U << 2U | 1U << 3U;
    Chip::power_sequence().wdsel.write(kAll & ~kOscillators);
}

}  // namespace detail

template <class Chip>
void feed_watchdog() noexcept
{
    Chip::watchdog().load.write(detail::kWatchdogMicroseconds);
}

// Resets the chip if feed_watchdog() is not called for 3 s. An erase takes 0.4 s at most. It stops while a debugger
// holds the core.
template <class Chip>
void start_watchdog() noexcept
{
    constexpr std::uint32_t kEnable = 1U << 30U;
    constexpr std::uint32_t kPausedByDebugger = 7U << 24U;
    detail::prepare_reset<Chip>();
    feed_watchdog<Chip>();
    Chip::watchdog().ctrl.write(kEnable | kPausedByDebugger);
}

// Restarts the chip: everything but the memory is as after power-up.
template <class Chip>
[[noreturn]] void reset_chip() noexcept
{
    constexpr std::uint32_t kTrigger = 1U << 31U;
    detail::prepare_reset<Chip>();
    __asm volatile("" ::: "memory");
    Chip::watchdog().ctrl.write(kTrigger);
    for (;;) {
    }
}

}  // namespace cusp::hal::rp2350
