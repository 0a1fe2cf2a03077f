// Checks of a board's table that the rules for pins of every family of chips share.
#pragma once

#include <cstddef>

#include "boards/mill3/mill_panel.hpp"

namespace cusp::boards::detail {

template <class AllPins>
constexpr bool names_one(const AllPins& all, typename AllPins::value_type pin) noexcept
{
    for (const auto used : all) {
        if (is_there(used) && same(used, pin)) {
            return true;
        }
    }
    return false;
}
template <class AllPins>
constexpr bool names_one_twice(const AllPins& all) noexcept
{
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t k = i + 1; k < all.size(); ++k) {
            if (is_there(all[i]) && same(all[i], all[k])) {
                return true;
            }
        }
    }
    return false;
}
// Every board has six lines, all inputs but the second motor's switch and the spindle's, an enable line,
// the outputs.
template <class LinePins, class PanelPins>
constexpr bool is_complete(const LinePins& lines, const PanelPins& panel) noexcept
{
    bool complete = is_there(panel.drives_off[0]) && is_there(panel.flood) &&
                    is_there(panel.mist) && is_there(panel.spindle_on) &&
                    is_there(panel.spindle_reverse) && is_there(panel.spindle_pulses.pin);
    for (unsigned i = 0; i < 6; ++i) {
        complete = complete && is_there(lines[i]);
    }
    const auto inputs = input_pins(panel);
    for (unsigned i = 0; i + 2 < inputs.size(); ++i) {
        complete = complete && is_there(inputs[i]);
    }
    return complete;
}

}  // namespace cusp::boards::detail
