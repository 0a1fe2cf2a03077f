// A boot loader that starts the image at 0x08008000 and leaves much behind: the clock from the multiplier, the
// core's timer and all interrupts on and pending, all exceptions off by PRIMASK, its own vectors in force.
#include <array>

#include "hal/cortex_m/vectors.hpp"
#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/clock_tree.hpp"

using namespace cusp;
using hal::stm32f4::Chip;

namespace {

constexpr std::uint32_t kImage = 0x08008000;

// The core leaves for the image with the stack that its first vector names.
[[noreturn]] __attribute__((naked)) void jump(std::uint32_t /*stack*/, std::uint32_t /*entry*/)
{
    __asm volatile("msr msp, r0\n bx r1");
}

}  // namespace

extern "C" {
void cusp_rest() {}
void cusp_board_stop()
{
    for (;;) {
    }
}
void cusp_servo_tick() {}
void cusp_player_interrupt() {}
void cusp_serial_interrupt() {}
}

void cusp_main()
{
    // The regulator stays at its full scale, whose bits differ from chip to chip.
    static_cast<void>(hal::stm32f4::start_clocks<Chip>({8000000, 168000000, 5, 2, 4, 0}));
    __asm volatile("cpsid i" ::: "memory");
    Chip::system_timer().load.write(1000);
    Chip::system_timer().ctrl.write(7);
    for (unsigned i = 0; i < 3; ++i) {
        Chip::interrupts().iser[i].write(0xFFFFFFFFU);
        Chip::interrupts().ispr[i].write(0xFFFFFFFFU);
    }
    hal::stm32f4::pend_servo_tick<Chip>();
    jump(Chip::read_memory(kImage), Chip::read_memory(kImage + 4));
}

namespace {

constexpr std::array<hal::cortex_m::InterruptEntry, 0> kInterrupts{};

__attribute__((section(".vectors"), used)) constexpr auto kVectors =
    hal::cortex_m::make_vectors<hal::stm32f4::kInterruptCount>(
        &cusp_stack_top, cusp_reset, cusp_exception, cusp_servo_tick, kInterrupts);

}  // namespace
