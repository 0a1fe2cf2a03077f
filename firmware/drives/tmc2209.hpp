// The TMC2209: what a motor needs as words, and the words as bytes of its single wire (data sheet revision
// 1.09, sections 4 and 5).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/drives/drive_kind.hpp"

namespace cusp::drives::tmc2209 {

inline constexpr std::size_t kReplySize = 8;
inline constexpr float kMostMilliamperes = 1700;

// The count of writes is read before and after them.
inline constexpr std::array<Step, 12> kSetting{{
    {Register::kInputs, Action::kReadVersion},
    {Register::kWriteCount, Action::kCountBefore},
    {Register::kGlobalSettings, Action::kWrite},
    {Register::kChopper, Action::kWrite},
    {Register::kCurrents, Action::kWrite},
    {Register::kHoldDelay, Action::kWrite},
    {Register::kStealthLimit, Action::kWrite},
    {Register::kGlobalStatus, Action::kWrite},
    {Register::kWriteCount, Action::kCountAfter},
    {Register::kGlobalSettings, Action::kCompare},
    {Register::kChopper, Action::kCompare},
    {Register::kStatus, Action::kReadStatus},
}};
inline constexpr std::array<Step, 2> kWatching{{
    {Register::kStatus, Action::kReadStatus},
    {Register::kGlobalStatus, Action::kReadRestarts},
}};
inline constexpr Recipe kRecipe{kSetting, kWatching, 0x21, 1U << 1U, 0xFU << 2U, 0, true, false};

// Section 4.2: polynomial x^8 + x^2 + x + 1, the lowest bit of each byte first.
std::uint8_t crc8(Span<const std::uint8_t> bytes) noexcept;

// To the drive of address 0.
Datagram read_request(Register from) noexcept;
Datagram write_request(Register to, std::uint32_t value) noexcept;
// The value in an answer to read_request(from). Nothing where it is none, or its checksum is wrong.
std::optional<std::uint32_t> parse_reply(Span<const std::uint8_t> bytes, Register from) noexcept;

// The current is that of the next lower of 32 steps, never more than asked for but for the least step.
DriveRegisters registers_for(const MotorSetup& setup) noexcept;

}  // namespace cusp::drives::tmc2209
