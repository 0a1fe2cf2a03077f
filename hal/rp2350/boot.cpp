// The first words of the flash: what the boot ROM looks for, and the copy of the image to RAM.
#include <array>
#include <cstdint>

#include "hal/rp2350/chip_clocks.hpp"
#include "hal/rp2350/rp2350.hpp"

extern "C" {
extern const std::uint32_t cusp_stack_top;
[[noreturn]] void cusp_boot();
void cusp_boot_clocks();
void cusp_boot_copy();
}

namespace {

// The boot ROM takes stack and entry from here. The block says that this is a program for the secure state of the chip's
// Arm cores, and that no other block follows (data sheet, 5.9.5.1).
struct Head {
    const void* stack;
    void (*entry)();
    std::array<std::uint32_t, 5> block;
};
__attribute__((section(".boot.head"), used)) constexpr Head kHead{
    &cusp_stack_top, cusp_boot, {0xFFFFDED3, 0x10210142, 0x000001FF, 0x00000000, 0xAB123579}};

}  // namespace

extern "C" {
// At the clock that the boot ROM leaves, the copy would take ten times as long. Whether the clocks have started is
// looked at later, by whoever can say so. Everything that it calls is part of it, and so in the flash: tests/checks/image.py.
__attribute__((flatten, section(".boot"))) void cusp_boot_clocks()
{
    static_cast<void>(cusp::hal::rp2350::start_clocks<cusp::hal::rp2350::Chip>());
}

// Runs in the flash. The stack's limit of whoever ran before is no more; the floating-point unit is on for cusp_rest(),
// which drives the outputs as soon as it is there.
__attribute__((naked, section(".boot"))) void cusp_boot()
{
    __asm volatile(
        "movs r0, #0\n"
        "msr msplim, r0\n"
        "bl cusp_boot_clocks\n"
        "ldr r0, =cusp_image_load\n"
        "ldr r1, =cusp_image_begin\n"
        "ldr r2, =cusp_early_end\n"
        "bl cusp_boot_copy\n"
        "ldr r0, =0xE000ED88\n"
        "ldr r1, [r0]\n"
        "orr r1, r1, #0xF00000\n"
        "str r1, [r0]\n"
        "dsb\n"
        "isb\n"
        "ldr r0, =cusp_rest\n"
        "blx r0\n"
        "ldr r0, =cusp_early_load_end\n"
        "ldr r1, =cusp_early_end\n"
        "ldr r2, =cusp_image_end\n"
        "bl cusp_boot_copy\n"
        "dsb\n"
        "isb\n"
        "ldr r0, =cusp_reset\n"
        "bx r0\n"
        ".ltorg");
}

// From r0 on to r1 on, up to r2, in pieces of 16 bytes.
__attribute__((naked, section(".boot"))) void cusp_boot_copy()
{
    __asm volatile(
        "1: cmp r1, r2\n"
        "it hs\n"
        "bxhs lr\n"
        "ldmia r0!, {r4-r7}\n"
        "stmia r1!, {r4-r7}\n"
        "b 1b\n");
}
}
