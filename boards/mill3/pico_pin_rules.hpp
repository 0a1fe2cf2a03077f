// PicoPinRules: what the compiler finds wrong in the table of pins of a board with a Pico 2, so that no such board is
// built.
#pragma once

#include <array>
#include <cstddef>

#include "boards/mill3/pin_checks.hpp"
#include "hal/rp2350/gp_pins.hpp"
#include "hal/rp2350/pulse_program.hpp"
#include "hal/rp2350/pwm_pulses.hpp"

namespace cusp::boards {

// The panel of a board with an RP2350.
using PicoPanelPins = PanelPinsOf<hal::rp2350::Pin, hal::rp2350::PulsePin>;

namespace detail {

using AllPicoPins = std::array<hal::rp2350::Pin, 8 + 12 + 10>;
template <class Table>
constexpr AllPicoPins all_pico_pins() noexcept
{
    AllPicoPins all{};
    std::size_t count = 0;
    for (const auto pin : Table::kLines) {
        all[count++] = pin;
    }
    for (const auto pin : input_pins(Table::kPanelPins)) {
        all[count++] = pin;
    }
    for (const auto pin : output_pins(Table::kPanelPins)) {
        all[count++] = pin;
    }
    return all;
}
constexpr bool all_on_the_edge(const AllPicoPins& all) noexcept
{
    for (const auto pin : all) {
        const bool there = pin.number <= 22 || (pin.number >= 26 && pin.number <= 28);
        if (is_there(pin) && !there) {
            return false;
        }
    }
    return true;
}

}  // namespace detail

// `Table` as in boards/mill3/pico_traits.hpp, `SerialLink` its serial line. kHold is true, or nothing compiles.
template <class Table, class SerialLink>
struct PicoPinRules {
    static constexpr detail::AllPicoPins kAll = detail::all_pico_pins<Table>();

    static_assert(detail::all_on_the_edge(kAll),
                  "a pin is none of GP0 to GP22 and GP26 to GP28, which the Pico 2 brings out");
    static_assert(detail::is_complete(Table::kLines, Table::kPanelPins),
                  "a line, input or output has no pin");
    static_assert(!detail::names_one_twice(kAll), "a pin is named twice");
    static_assert(!detail::names_one(kAll, SerialLink::kTransmit) &&
                      !detail::names_one(kAll, SerialLink::kReceive),
                  "a pin is the serial port's");
    static_assert(is_there(Table::kLines[6]) == is_there(Table::kLines[7]),
                  "the second motor has a step without a direction, or the other way round");

    static constexpr bool kHold = true;
};

}  // namespace cusp::boards
