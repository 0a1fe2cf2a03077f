// MillBoard: the 3-axis mill controller, composed of the parts that its traits name.
#pragma once

#include "hal/contract/board.hpp"

namespace cusp::boards {

// Boards of this kind differ only in `Traits`; boards/mill3/chip_traits.hpp lists its
// members.
template <class Traits>
struct MillBoard {
    // Sets up clocks and pins before the application is constructed.
    MillBoard() noexcept { Traits::start(*this); }
    MillBoard(const MillBoard&) = delete;
    MillBoard& operator=(const MillBoard&) = delete;

    static constexpr std::uint32_t kMostStepsPerSecond = Traits::kMostStepsPerSecond;
    static constexpr bool kSecondMotor = Traits::kSecondMotor;
    static constexpr bool kAtSpeedInput = Traits::kAtSpeedInput;

    typename Traits::PulsePlayer pulse_player;
    typename Traits::ByteLink byte_link;
    typename Traits::Panel panel;
    typename Traits::SettingsStore settings_store;
};

}  // namespace cusp::boards
