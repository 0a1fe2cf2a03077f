// MillBoard: the 3-axis mill controller, put together of the parts that its traits name.
#pragma once

#include "hal/contract/board.hpp"

namespace cusp::boards {

// `Traits` is the one place where boards of this kind differ; boards/mill3/chip_traits.hpp says what
// it holds.
template <class Traits>
struct MillBoard {
    // Clocks and pins first: the application that is made next finds a board that works.
    MillBoard() noexcept { Traits::start(*this); }
    MillBoard(const MillBoard&) = delete;
    MillBoard& operator=(const MillBoard&) = delete;

    static constexpr std::uint32_t kMostStepsPerSecond = Traits::kMostStepsPerSecond;
    static constexpr bool kSecondMotor = Traits::kSecondMotor;

    typename Traits::PulsePlayer pulse_player;
    typename Traits::ByteLink byte_link;
    typename Traits::Panel panel;
    typename Traits::SettingsStore settings_store;
};

}  // namespace cusp::boards
