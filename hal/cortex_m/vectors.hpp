// The vector table: where the core finds the stack and the function of each interrupt.
#pragma once

#include <array>
#include <cstdint>

namespace cusp::hal::cortex_m {

using InterruptFunction = void (*)();

// Exceptions of the core take the first fifteen places, the chip's interrupts the rest.
inline constexpr unsigned kCoreExceptions = 15;
inline constexpr unsigned kPendSvException = 14;

template <unsigned kInterrupts>
struct VectorTable {
    const void* stack_top;
    std::array<InterruptFunction, kCoreExceptions + kInterrupts> functions;
};

struct InterruptEntry {
    unsigned number;  // of the chip's interrupts
    InterruptFunction function;
};

// A table with `reset`, `servo_tick` at PendSV, the entries, and `fault` everywhere else: an
// unexpected interrupt is a fault.
template <unsigned kInterrupts, std::size_t N>
constexpr VectorTable<kInterrupts> make_vectors(
    const void* stack_top,
    InterruptFunction reset,
    InterruptFunction fault,
    InterruptFunction servo_tick,
    const std::array<InterruptEntry, N>& entries) noexcept
{
    VectorTable<kInterrupts> table{stack_top, {}};
    for (InterruptFunction& function : table.functions) {
        function = fault;
    }
    table.functions[0] = reset;
    table.functions[kPendSvException - 1] = servo_tick;
    for (const InterruptEntry& entry : entries) {
        table.functions[kCoreExceptions + entry.number] = entry.function;
    }
    return table;
}

}  // namespace cusp::hal::cortex_m

extern "C" {
// By the linker script.
extern std::uint32_t cusp_stack_top;
// By hal/cortex_m/start_up.cpp.
void cusp_reset();
void cusp_exception();
// By the board: what runs after the start. Not main(), which has no C linkage without a C library.
// The first call after a reset, before statics have their values: outputs at rest.
void cusp_rest();
[[noreturn]] void cusp_main();
// By the board: steps low, drives off, and the handling of the fault. Context: any.
[[noreturn]] void cusp_board_stop();
void cusp_servo_tick();
void cusp_player_interrupt();
void cusp_serial_interrupt();
// Only of a board with USB.
void cusp_usb_interrupt();
}
