// The mill controller's pins, but for the serial line. README.md has them all as a wiring table.
#pragma once

#include "boards/mill3/mill_panel.hpp"

namespace cusp::boards {

// The six step and direction lines: pins 0 to 5 of port C, so that one word moves any of them.
template <class Chip>
struct MillStepPort {
    static auto& gpio() noexcept { return Chip::port_c(); }
};

inline constexpr PanelPins kMillPins{
    {{{'B', 12}, {'B', 13}, {'B', 14}, {'B', 15}}},
    {{{'B', 8}, {'B', 9}, {'B', 6}, {'B', 7}}},
    {{{'B', 10}, {'B', 11}}},
    {'C', 6},
    {'C', 7},
    {'C', 8},
    {'A', 5},
    {'A', 7},
    {'A', 6},
};

}  // namespace cusp::boards
