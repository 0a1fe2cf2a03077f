// The clocks: 168 MHz from the crystal, or from the chip's own oscillator where no crystal starts.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

inline constexpr std::uint32_t kCoreHz = 168000000;
// Timers on the fast bus count at the core's rate; the bus itself runs at half of it.
inline constexpr std::uint32_t kFastBusHz = kCoreHz / 2;
inline constexpr std::uint32_t kFastTimerHz = kCoreHz;
inline constexpr std::uint32_t kSlowTimerHz = kCoreHz / 2;

enum class ClockSource : std::uint8_t {
    kCrystal,     // 50 ppm or so: what the board is made for
    kOscillator,  // 1 %: the crystal did not start; moves are right, times are not
    kNone,        // the multiplier did not lock: the chip runs at 16 MHz, no motion is possible
};

namespace detail {

// Every wait for the chip ends: a register that never changes is an answer too.
inline constexpr std::uint32_t kReadyRounds = 200000;

template <class Word>
bool wait_for(Word& word, std::uint32_t mask, std::uint32_t value) noexcept
{
    for (std::uint32_t round = 0; round < kReadyRounds; ++round) {
        if ((word.read() & mask) == value) {
            return true;
        }
    }
    return false;
}

}  // namespace detail

// Sets up 168 MHz for the core, 84 MHz for the fast and 42 MHz for the slow bus; 5 wait states.
// RM0090 section 7.3: crystal / M = 2 MHz, x 168 = 336 MHz, / 2 = 168 MHz, / 7 = 48 MHz.
template <class Chip>
ClockSource start_clocks(std::uint32_t crystal_hz) noexcept
{
    constexpr std::uint32_t kCrystalOn = 1U << 16U;
    constexpr std::uint32_t kCrystalReady = 1U << 17U;
    constexpr std::uint32_t kMultiplierOn = 1U << 24U;
    constexpr std::uint32_t kMultiplierReady = 1U << 25U;
    constexpr std::uint32_t kFromCrystal = 1U << 22U;
    constexpr std::uint32_t kOscillatorHz = 16000000;
    constexpr std::uint32_t kInputHz = 2000000;
    auto& rcc = Chip::rcc();
    set_bits(rcc.cr, kCrystalOn);
    const bool crystal = detail::wait_for(rcc.cr, kCrystalReady, kCrystalReady);
    const std::uint32_t divisor = (crystal ? crystal_hz : kOscillatorHz) / kInputHz;
    rcc.pllcfgr.write(divisor | 168U << 6U | 0U << 16U | (crystal ? kFromCrystal : 0) | 7U << 24U);
    set_bits(rcc.cr, kMultiplierOn);
    if (!detail::wait_for(rcc.cr, kMultiplierReady, kMultiplierReady)) {
        return ClockSource::kNone;
    }
    // Prefetch, both caches, five wait states: before the clock rises.
    Chip::flash().acr.write(5U | 1U << 8U | 1U << 9U | 1U << 10U);
    // Slow bus by 4, fast bus by 2, then the core's clock from the multiplier.
    rcc.cfgr.write(5U << 10U | 4U << 13U);
    rcc.cfgr.write(5U << 10U | 4U << 13U | 2U);
    if (!detail::wait_for(rcc.cfgr, 3U << 2U, 2U << 2U)) {
        return ClockSource::kNone;
    }
    return crystal ? ClockSource::kCrystal : ClockSource::kOscillator;
}

}  // namespace cusp::hal::stm32f4
