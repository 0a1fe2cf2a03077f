// Pins: what each is for, set once at the start.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// A pin by its name on the schematic: {'C', 6}. Port 0: the board has none.
struct Pin {
    char port{0};  // 'A' to 'I'
    unsigned number{0};
};
constexpr bool is_there(Pin pin) noexcept { return pin.port != 0; }
constexpr bool same(Pin a, Pin b) noexcept { return a.port == b.port && a.number == b.number; }
// Its port's bit in RCC_AHB1ENR.
constexpr std::uint32_t clock_bit(Pin pin) noexcept
{
    return is_there(pin) ? 1U << static_cast<unsigned>(pin.port - 'A') : 0U;
}

enum class PinMode : std::uint8_t { kInput = 0, kOutput = 1, kAlternate = 2 };
enum class Pull : std::uint8_t { kNone = 0, kUp = 1, kDown = 2 };

template <class Word>
void set_pin(Gpio<Word>& port, unsigned pin, PinMode mode, Pull pull = Pull::kNone) noexcept
{
    set_field(port.pupdr, pin * 2, 2, static_cast<std::uint32_t>(pull));
    set_field(port.moder, pin * 2, 2, static_cast<std::uint32_t>(mode));
}

// Gives the pin to a peripheral: `function` as in the data sheet's table of alternate functions.
template <class Word>
void set_pin_function(Gpio<Word>& port,
                      unsigned pin,
                      unsigned function,
                      Pull pull = Pull::kUp) noexcept
{
    set_field(pin < 8 ? port.afrl : port.afrh, pin % 8 * 4, 4, function);
    set_pin(port, pin, PinMode::kAlternate, pull);
}

// Sets an output to a level. One store: no interrupt can come between.
template <class Word>
void set_level(Gpio<Word>& port, unsigned pin, bool level) noexcept
{
    port.bsrr.write(level ? 1U << pin : 1U << (pin + 16));
}

// A panel reads and drives its pins by this (boards/mill3/mill_panel.hpp).
template <class Chip>
struct PinAccess {
    static constexpr bool kPullsDown = true;  // where it is asked for

    static void make_input(Pin pin, bool pulled_down) noexcept
    {
        set_pin(Chip::port(pin.port), pin.number, PinMode::kInput,
                pulled_down ? Pull::kDown : Pull::kUp);
    }
    static void make_output(Pin pin) noexcept
    {
        set_pin(Chip::port(pin.port), pin.number, PinMode::kOutput);
    }
    // 0 or 1.
    static std::uint32_t level(Pin pin) noexcept
    {
        return Chip::port(pin.port).idr.read() >> pin.number & 1U;
    }
    static void put(Pin pin, bool high) noexcept
    {
        set_level(Chip::port(pin.port), pin.number, high);
    }
};

}  // namespace cusp::hal::stm32f4
