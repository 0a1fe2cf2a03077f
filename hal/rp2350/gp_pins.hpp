// Pins: what each is for, set once at the start.
#pragma once

#include <cstdint>

#include "hal/rp2350/chip_registers.hpp"

namespace cusp::hal::rp2350 {

// A pin by its number on the board: GP(5). The board has none where it is not said.
struct Pin {
    static constexpr unsigned kNone = 255;
    unsigned number{kNone};
};
constexpr Pin GP(unsigned number) noexcept { return {number}; }
constexpr bool is_there(Pin pin) noexcept { return pin.number != Pin::kNone; }
constexpr bool same(Pin a, Pin b) noexcept { return a.number == b.number; }
constexpr std::uint32_t bit_of(Pin pin) noexcept { return is_there(pin) ? 1U << pin.number : 0U; }

// 9.4: functions of a pin.
enum class PinFunction : std::uint8_t { kUart = 2, kPwm = 4, kCore = 5, kPio0 = 6 };

// 9.11.3: a pad.
inline constexpr std::uint32_t kPadSchmitt = 1U << 1U;
inline constexpr std::uint32_t kPadPullUp = 1U << 3U;
inline constexpr std::uint32_t kPad4Milliamperes = 1U << 4U;
inline constexpr std::uint32_t kPadInput = 1U << 6U;
inline constexpr std::uint32_t kPadOutput = kPadSchmitt | kPad4Milliamperes;

// The function first: the pad is cut off from it after a reset, until its isolation ends.
template <class Chip>
void set_pin_function(Pin pin, PinFunction function, std::uint32_t pad) noexcept
{
    Chip::functions().pin[pin.number].ctrl.write(static_cast<std::uint32_t>(function));
    Chip::pads().pin[pin.number].write(pad);
}

// A panel reads and drives its pins by this (boards/mill3/mill_panel.hpp).
template <class Chip>
struct PinAccess {
    // Erratum E9: a pull-down inside does not bring a pin low.
    static constexpr bool kPullsDown = false;

    static void make_input(Pin pin, bool /*pulled_down*/) noexcept
    {
        set_pin_function<Chip>(pin, PinFunction::kCore,
                               kPadInput | kPadPullUp | kPadSchmitt | kPad4Milliamperes);
    }
    static void make_output(Pin pin) noexcept
    {
        Chip::core_pins().enable_set.write(bit_of(pin));
        set_pin_function<Chip>(pin, PinFunction::kCore, kPadOutput);
    }
    // 0 or 1.
    static std::uint32_t level(Pin pin) noexcept
    {
        return Chip::core_pins().in.read() >> pin.number & 1U;
    }
    static void put(Pin pin, bool high) noexcept
    {
        (high ? Chip::core_pins().out_set : Chip::core_pins().out_clear).write(bit_of(pin));
    }
};

}  // namespace cusp::hal::rp2350
