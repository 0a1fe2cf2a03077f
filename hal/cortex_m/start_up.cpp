// From reset to cusp_main(): floating-point unit, outputs at rest, initial values of statics, constructors. From a
// fault of the core to fault_entry(), with the registers that the core has saved.
#include <cstdint>

#include "hal/cortex_m/cortex_m.hpp"
#include "hal/cortex_m/fault_record.hpp"
#include "hal/cortex_m/vectors.hpp"

namespace {

using Core = cusp::hal::cortex_m::Core;
using Constructor = void (*)();

// As after a reset: a boot loader that has started the firmware may have left the core's timer, interrupts
// and its own table in force, or all interrupts off.
void quieten_core(std::uint32_t vectors) noexcept
{
    constexpr std::uint32_t kPendingOff = 1U << 27U | 1U << 25U;  // PendSV, SysTick
    constexpr unsigned kWords = 3;  // no chip here has more than 96 interrupts
    __asm volatile("cpsid i" ::: "memory");
    Core::system_timer().ctrl.write(0);
    for (unsigned i = 0; i < kWords; ++i) {
        Core::interrupts().icer[i].write(0xFFFFFFFFU);
        Core::interrupts().icpr[i].write(0xFFFFFFFFU);
    }
    Core::system().icsr.write(kPendingOff);
    Core::system().vtor.write(vectors);
    __asm volatile("dsb\n isb\n cpsie i" ::: "memory");
}

}  // namespace

extern "C" {
extern std::uint32_t cusp_data_load, cusp_data_begin, cusp_data_end;
extern std::uint32_t cusp_zero_begin, cusp_zero_end;
extern std::uint32_t cusp_coupled_begin, cusp_coupled_end;
extern const std::uint32_t cusp_vectors;
extern Constructor cusp_constructors_begin, cusp_constructors_end;

void cusp_reset()
{
    // The compiler may use float registers anywhere, so the unit is enabled first.
    constexpr std::uint32_t kFullAccess = 0xFU << 20U;
    cusp::hal::cortex_m::set_bits(Core::system().cpacr, kFullAccess);
    quieten_core(Core::bus_address(&cusp_vectors));

    // The memory takes 10 ms at the clock of the reset; outputs do not wait for it.
    cusp_rest();

    const std::uint32_t* from = &cusp_data_load;
    for (std::uint32_t* to = &cusp_data_begin; to < &cusp_data_end; ++to) {
        *to = *from++;
    }
    for (std::uint32_t* to = &cusp_zero_begin; to < &cusp_zero_end; ++to) {
        *to = 0;
    }
    for (std::uint32_t* to = &cusp_coupled_begin; to < &cusp_coupled_end; ++to) {
        *to = 0;
    }
    for (const Constructor* constructor = &cusp_constructors_begin;
         constructor != &cusp_constructors_end; ++constructor) {
        (*constructor)();
    }
    cusp_main();
}

[[noreturn]] void cusp_exception_with_frame(const std::uint32_t* frame)
{
    // The core saves r0 to r3, r12, lr, pc, psr; nowhere where the stack has overflowed.
    const std::uint32_t pc = frame != nullptr ? frame[6] : 0;
    const std::uint32_t lr = frame != nullptr ? frame[5] : 0;
    cusp::hal::cortex_m::core_fault(Core::system().icsr.read() & 0x1FFU, pc, lr,
                                    Core::system().cfsr.read());
}

// The saved registers lie on the stack that was in use; only the main one is used here. If less
// than 256 bytes of it are left, the handler begins it anew: it could not run otherwise, and the
// pulse stream would play on.
__attribute__((naked)) void cusp_exception()
{
    __asm volatile(
        "mrs r0, msp\n"
        "ldr r1, =cusp_stack_bottom\n"
        "add r2, r1, #256\n"
        "cmp r0, r2\n"
        "bhs 1f\n"
        "ldr r2, =cusp_stack_top\n"
        "msr msp, r2\n"
        "cmp r0, r1\n"
        "bhs 1f\n"
        "movs r0, #0\n"
        "1: b cusp_exception_with_frame\n"
        ".ltorg");
}
}
