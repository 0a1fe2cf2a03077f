// Reports over the serial line why the firmware stopped last time, and faults of its clock.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/base/span.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/fault_record.hpp"

namespace cusp::hal::stm32f4 {

namespace detail {

template <class Link>
void write_text(Link& link, std::string_view text) noexcept
{
    for (const char c : text) {
        const auto byte = static_cast<std::uint8_t>(c);
        if (link.write_room() > 0) {
            link.write({&byte, 1});
        }
    }
}

template <class Link>
void write_number(Link& link, std::uint32_t value, unsigned base) noexcept
{
    char digits[10]{};
    unsigned count = 0;
    do {
        digits[count] = "0123456789abcdef"[value % base];
        value /= base;
        ++count;
    } while (value != 0);
    while (count > 0) {
        --count;
        write_text(link, {&digits[count], 1});
    }
}

}  // namespace detail

// Writes `[MSG:Fault: ...]` if there is a record, and clears it. The record is in memory that only a
// loss of power changes.
template <class Link>
void report_last_fault(Link& link) noexcept
{
    using detail::write_number;
    using detail::write_text;
    if (last_fault.mark != FaultRecord::kWritten) {
        return;
    }
    last_fault.mark = 0;
    write_text(link, "[MSG:Fault: ");
    if (last_fault.exception == 0) {
        write_text(link, last_fault.expression);
        write_text(link, ", ");
        write_text(link, last_fault.file);
        write_text(link, ":");
        write_number(link, static_cast<std::uint32_t>(last_fault.line), 10);
    } else {
        write_text(link, "exception ");
        write_number(link, last_fault.exception, 10);
        write_text(link, ", pc ");
        write_number(link, last_fault.program_counter, 16);
        write_text(link, ", lr ");
        write_number(link, last_fault.link_register, 16);
        write_text(link, ", cfsr ");
        write_number(link, last_fault.fault_status, 16);
    }
    write_text(link, "]\r\n");
}

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

inline void mark_motion(bool moving) noexcept
{
    last_reset.motion = moving ? ResetRecord::kMoving : 0U;
}
inline bool reset_amid_motion() noexcept { return last_reset.motion == ResetRecord::kMoving; }

// The messages of a start: a fault, the watchdog, a brown-out, a clock that is not the planned
// one.
template <class Link>
void report_reset(Link& link, ClockSource clock) noexcept
{
    using detail::write_text;
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
