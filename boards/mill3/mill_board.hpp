// MillBoard: the 3-axis mill controller, composed of the parts that its traits name.
#pragma once

#include <cstdint>
#include <type_traits>

#include "hal/contract/board.hpp"

namespace cusp::boards {
namespace detail {

// Only a board with wires to its drives has their part.
template <class Traits, class = void>
struct DrivePart {
};
template <class Traits>
struct DrivePart<Traits, std::enable_if_t<Traits::kDriveWires != 0>> {
    static constexpr std::uint8_t kDriveWires = Traits::kDriveWires;
    static constexpr float kSenseMilliohms = Traits::kSenseMilliohms;

    typename Traits::DriveWire drive_wire;
};

template <class Traits, class = void>
struct DriveBusPart {
};
template <class Traits>
struct DriveBusPart<Traits, std::enable_if_t<Traits::kDriveBus>> {
    static constexpr float kBusSenseMilliohms = Traits::kBusSenseMilliohms;

    typename Traits::DriveBus drive_bus;
};

// And only one with a line to a spindle's drive has that.
template <class Traits, class = void>
struct SpindlePart {
};
template <class Traits>
struct SpindlePart<Traits, std::enable_if_t<Traits::kSpindleWire>> {
    typename Traits::SpindleWire spindle_wire;
};

}  // namespace detail

// Boards of this kind differ only in `Traits`; boards/mill3/chip_traits.hpp lists its
// members.
template <class Traits>
struct MillBoard : detail::DrivePart<Traits>,
                   detail::DriveBusPart<Traits>,
                   detail::SpindlePart<Traits> {
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
