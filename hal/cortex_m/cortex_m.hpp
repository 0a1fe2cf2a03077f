// The core of a chip, a Cortex-M4 or M33: its own registers, and what every family of chips here shares.
//
//   struct Chip : cortex_m::Core { ... };          // and a function for each block of the chip
//   cortex_m::enable_interrupt<Chip>(37, cortex_m::kSerialPriority);
//
// vectors.hpp says what the core calls; start_up.cpp leads from a reset to the board's cusp_main(), fault.cpp from a
// fault to a record that the next start reports (reset_report.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

namespace cusp::hal::cortex_m {

// One 32-bit register of the chip.
class DeviceWord {
public:
    std::uint32_t read() const noexcept { return value_; }
    void write(std::uint32_t value) noexcept { value_ = value; }

private:
    volatile std::uint32_t value_;
};

template <class Word>
void set_bits(Word& word, std::uint32_t bits) noexcept
{
    word.write(word.read() | bits);
}
template <class Word>
void clear_bits(Word& word, std::uint32_t bits) noexcept
{
    word.write(word.read() & ~bits);
}
// Puts `value` into the field that lies at `shift` and is `width` bits wide.
template <class Word>
void set_field(Word& word, unsigned shift, unsigned width, std::uint32_t value) noexcept
{
    const std::uint32_t mask = ((1U << width) - 1U) << shift;
    word.write((word.read() & ~mask) | (value << shift & mask));
}

// Every wait for the chip is bounded: a register that never changes counts as a failure.
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

// The core's own blocks, by the names of PM0214 in lower case: sections 4.3 and 4.4. The Cortex-M33 has the same
// registers at the same addresses.
template <class Word>
struct InterruptController {
    Word iser[8], reserved_20[24];
    Word icer[8], reserved_a0[24];
    Word ispr[8], reserved_120[24];
    Word icpr[8], reserved_1a0[24];
    Word iabr[8], reserved_220[56];
    Word ipr[60];
};
static_assert(offsetof(InterruptController<DeviceWord>, icer) == 0x80);
static_assert(offsetof(InterruptController<DeviceWord>, ipr) == 0x300);

// Section 4.5.
template <class Word>
struct SystemTimer {
    Word ctrl, load, val, calib;
};

template <class Word>
struct SystemControl {
    Word cpuid, icsr, vtor, aircr, scr, ccr, shpr1, shpr2, shpr3, shcsr, cfsr, hfsr, dfsr, mmfar;
    Word bfar, afsr, reserved_40[18], cpacr;
};
static_assert(offsetof(SystemControl<DeviceWord>, shpr3) == 0x20);
static_assert(offsetof(SystemControl<DeviceWord>, cfsr) == 0x28);
static_assert(offsetof(SystemControl<DeviceWord>, bfar) == 0x38);
static_assert(offsetof(SystemControl<DeviceWord>, cpacr) == 0x88);

// Only the target may call this: the address is that of the chip's block.
template <class Block>
Block& block_at(std::uintptr_t address) noexcept
{
    return *reinterpret_cast<Block*>(address);
}

// The base of each chip. Tests pass a type whose functions return models.
struct Core {
    using Word = DeviceWord;

    static InterruptController<Word>& interrupts() noexcept
    {
        return block_at<InterruptController<Word>>(0xE000E100);
    }
    static SystemTimer<Word>& system_timer() noexcept
    {
        return block_at<SystemTimer<Word>>(0xE000E010);
    }
    static SystemControl<Word>& system() noexcept
    {
        return block_at<SystemControl<Word>>(0xE000ED00);
    }

    // The bus address of a word of memory: DMA and flash use the same addresses as the core.
    static std::uint32_t bus_address(const volatile void* memory) noexcept
    {
        return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(memory));
    }
    static std::uint32_t read_memory(std::uint32_t address) noexcept
    {
        return block_at<Word>(address).read();
    }
    static void write_memory(std::uint32_t address, std::uint32_t value) noexcept
    {
        block_at<Word>(address).write(value);
    }
};

// Priorities: the higher the number, the less urgent; the chip has sixteen steps of 16.
inline constexpr std::uint32_t kPlayerPriority = 0x00;
inline constexpr std::uint32_t kSerialPriority = 0x40;
inline constexpr std::uint32_t kServoTickPriority = 0xC0;
inline constexpr std::uint32_t kUsbPriority = 0xE0;

template <class Chip>
void enable_interrupt(unsigned number, std::uint32_t priority) noexcept
{
    set_field(Chip::interrupts().ipr[number / 4], number % 4 * 8, 8, priority);
    Chip::interrupts().iser[number / 32].write(1U << number % 32);
}

// The servo tick runs in PendSV, below every interrupt that has a deadline of microseconds.
template <class Chip>
void pend_servo_tick() noexcept
{
    constexpr std::uint32_t kPendSvSet = 1U << 28U;
    Chip::system().icsr.write(kPendSvSet);
}

}  // namespace cusp::hal::cortex_m
