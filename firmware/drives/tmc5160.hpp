// The TMC5160: what a motor needs as words, and the words as datagrams of SPI (data sheet revision 1.17,
// sections 4 and 6).
//
// A datagram is a byte with the register's place, its highest bit set for a write, and a word. What a drive
// answers comes back with the next datagram: a byte of flags, and the word that was read or written. No checksum
// is with it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/drives/drive_kind.hpp"

namespace cusp::drives::tmc5160 {

inline constexpr std::size_t kReplySize = 5;

// The scaler goes before the currents: between them the motor has less than before or after.
inline constexpr std::array<Step, 11> kSetting{{
    {Register::kBusInputs, Action::kReadVersion},
    {Register::kGlobalSettings, Action::kWrite},
    {Register::kScaler, Action::kWrite},
    {Register::kCurrents, Action::kWrite},
    {Register::kChopper, Action::kWrite},
    {Register::kHoldDelay, Action::kWrite},
    {Register::kStealthLimit, Action::kWrite},
    {Register::kGlobalStatus, Action::kWrite},
    {Register::kGlobalSettings, Action::kCompare},
    {Register::kChopper, Action::kCompare},
    {Register::kStatus, Action::kReadStatus},
}};
// Zeros are no fault in the last two: the version says that somebody answers.
inline constexpr std::array<Step, 3> kWatching{{
    {Register::kBusInputs, Action::kReadVersion},
    {Register::kStatus, Action::kReadStatus},
    {Register::kGlobalStatus, Action::kReadRestarts},
}};
// Open coils are no fault: the drive sees them falsely at rest, when fast, and in stealthChop.
inline constexpr Recipe kRecipe{kSetting, kWatching, 0x30, 1U << 25U, 3U << 27U | 3U << 12U,
                                1U << 2U, false,     true};

Datagram read_request(Register from) noexcept;
Datagram write_request(Register to, std::uint32_t value) noexcept;
// The word in an answer. Nothing where nobody drives the line, which a resistor holds high.
std::optional<std::uint32_t> parse_reply(Span<const std::uint8_t> bytes) noexcept;

// The current is that of the next lower step of the scaler, never more than asked for but for the least.
DriveRegisters registers_for(const MotorSetup& setup) noexcept;

}  // namespace cusp::drives::tmc5160
