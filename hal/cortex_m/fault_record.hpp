// FaultRecord: the reason of the last stop of the firmware, in memory that a reset keeps.
#pragma once

#include <cstdint>

#include "firmware/base/assert.hpp"

namespace cusp::hal::cortex_m {

struct FaultRecord {
    // Marks a record written by fault(), as opposed to the memory's content at power-up.
    static constexpr std::uint32_t kWritten = 0x46415544;

    std::uint32_t mark;
    const char* expression;  // of the promise that was broken; null for a fault of the core
    const char* file;
    std::int32_t line;
    std::uint32_t exception;  // number of the core's exception; 0 for a broken promise
    std::uint32_t program_counter;
    std::uint32_t link_register;
    std::uint32_t fault_status;  // CFSR, PM0214 section 4.4.10
};

// Kept over a reset besides it: whether the machine moved, and the reason of the last reset.
struct ResetRecord {
    static constexpr std::uint32_t kMoving = 0x4D4F5645;

    std::uint32_t motion;  // kMoving while frames with edges are on their way
    std::uint32_t cause;   // what the chip says of this start
};
extern ResetRecord last_reset;

// The record that the last fault has left; its mark is kWritten if there was one.
extern FaultRecord last_fault;

// Records a fault of the core or an unexpected interrupt and ends as fault() does.
[[noreturn]] void core_fault(std::uint32_t exception,
                             std::uint32_t program_counter,
                             std::uint32_t link_register,
                             std::uint32_t fault_status) noexcept;

}  // namespace cusp::hal::cortex_m
