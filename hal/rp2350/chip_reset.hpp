// Reports over the serial line why the firmware stopped last time.
#pragma once

#include <cstdint>

#include "hal/cortex_m/reset_report.hpp"
#include "hal/rp2350/chip_registers.hpp"
#include "hal/rp2350/chip_watchdog.hpp"

namespace cusp::hal::rp2350 {
namespace detail {

inline constexpr std::uint32_t kByTimer = 1U << 0U;  // REASON of the watchdog
inline constexpr std::uint32_t kPowerUp = 1U << 16U;
inline constexpr std::uint32_t kBrownOut = 1U << 17U;

}  // namespace detail

// Keeps why the chip was reset, and forgets it for the next time. The power manager's flags are those of the last reset of
// the whole chip, to which a watchdog's does not count. Call before anything moves.
template <class Chip>
void note_reset_cause() noexcept
{
    using namespace detail;
    auto& watchdog = Chip::watchdog();
    const std::uint32_t by_watchdog = watchdog.reason.read() & 3U;
    const bool ours = watchdog.scratch[0].read() == kOurWatchdog;
    watchdog.scratch[0].write(0);
    if (by_watchdog == 0) {
        last_reset.cause = Chip::power().chip_reset.read() & (kPowerUp | kBrownOut);
    } else {
        last_reset.cause = ours ? by_watchdog : kPowerUp;
    }
    // The content of the memory is random, or the boot ROM's.
    if ((last_reset.cause & (kPowerUp | kBrownOut)) != 0) {
        last_reset.motion = 0;
        last_fault.mark = 0;
    }
}

// The messages of a start: a fault, the watchdog, a brown-out.
template <class Link>
void report_reset(Link& link) noexcept
{
    using cortex_m::detail::write_text;
    report_last_fault(link);
    const std::uint32_t cause = last_reset.cause;
    if ((cause & detail::kByTimer) != 0) {
        write_text(link, "[MSG:Reset by the watchdog]\r\n");
    } else if ((cause & detail::kBrownOut) != 0 && (cause & detail::kPowerUp) == 0) {
        write_text(link, "[MSG:Reset: the supply broke down]\r\n");
    }
    if (reset_amid_motion()) {
        write_text(link, "[MSG:Reset amid motion: the position is lost]\r\n");
    }
}

}  // namespace cusp::hal::rp2350
