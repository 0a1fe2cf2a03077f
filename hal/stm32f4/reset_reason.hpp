// Reports over the serial line why the firmware stopped last time, and faults of its clock.
#pragma once

#include <cstdint>

#include "hal/cortex_m/reset_report.hpp"
#include "hal/stm32f4/clock_tree.hpp"

namespace cusp::hal::stm32f4 {

namespace detail {

inline constexpr std::uint32_t kBrownOut = 1U << 25U;  // RCC_CSR, RM0090 section 7.3.21
inline constexpr std::uint32_t kPowerUp = 1U << 27U;
inline constexpr std::uint32_t kSoftware = 1U << 28U;
inline constexpr std::uint32_t kWatchdogs = 3U << 29U;

}  // namespace detail

// Keeps the flags of the reset and clears them for the next one. Call before anything moves.
template <class Chip>
void note_reset_cause() noexcept
{
    constexpr std::uint32_t kRemove = 1U << 24U;
    last_reset.cause = Chip::rcc().csr.read();
    Chip::rcc().csr.write(kRemove);
    // After a loss of power the content of the memory is random.
    if ((last_reset.cause & detail::kPowerUp) != 0) {
        last_reset.motion = 0;
        last_fault.mark = 0;
    }
}

// The messages of a start: a fault, the watchdog, a brown-out, a clock that is not the planned
// one.
template <class Link>
void report_reset(Link& link, ClockSource clock) noexcept
{
    using cortex_m::detail::write_text;
    report_last_fault(link);
    const std::uint32_t cause = last_reset.cause;
    if ((cause & detail::kWatchdogs) != 0) {
        write_text(link, "[MSG:Reset by the watchdog]\r\n");
    } else if ((cause & detail::kBrownOut) != 0 && (cause & detail::kPowerUp) == 0) {
        write_text(link, "[MSG:Reset: the supply broke down]\r\n");
    }
    if (reset_amid_motion()) {
        write_text(link, "[MSG:Reset amid motion: the position is lost]\r\n");
    }
    if (clock == ClockSource::kNoCrystal) {
        write_text(link, "[MSG:Clock: no crystal, times are off by up to 4 %]\r\n");
    } else if (clock == ClockSource::kOtherCrystal) {
        write_text(link, "[MSG:Clock: another crystal, times are off by up to 4 %]\r\n");
    }
}

}  // namespace cusp::hal::stm32f4
