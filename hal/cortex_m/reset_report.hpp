// Reports over the serial line why the firmware stopped last time.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/base/span.hpp"
#include "hal/cortex_m/fault_record.hpp"

namespace cusp::hal::cortex_m {

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

inline void mark_motion(bool moving) noexcept
{
    last_reset.motion = moving ? ResetRecord::kMoving : 0U;
}
inline bool reset_amid_motion() noexcept { return last_reset.motion == ResetRecord::kMoving; }

}  // namespace cusp::hal::cortex_m
