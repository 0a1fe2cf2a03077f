// Realtime commands: single bytes that act at once, whatever bytes wait in the buffer.
#pragma once

#include <cstdint>

namespace cusp::protocol {

// The numbers are the bytes of Grbl 1.1.
enum class RealtimeCommand : std::uint8_t {
    kReset = 0x18,
    kStatusReport = '?',
    kFeedHold = '!',
    kCycleStart = '~',
    kSafetyDoor = 0x84,
    kJogCancel = 0x85,
    kFeedOverrideReset = 0x90,
    kFeedOverrideCoarsePlus = 0x91,
    kFeedOverrideCoarseMinus = 0x92,
    kFeedOverrideFinePlus = 0x93,
    kFeedOverrideFineMinus = 0x94,
    kRapidOverrideReset = 0x95,
    kRapidOverrideMedium = 0x96,
    kRapidOverrideLow = 0x97,
    kSpindleOverrideReset = 0x99,
    kSpindleOverrideCoarsePlus = 0x9A,
    kSpindleOverrideCoarseMinus = 0x9B,
    kSpindleOverrideFinePlus = 0x9C,
    kSpindleOverrideFineMinus = 0x9D,
    kSpindleStopToggle = 0x9E,
    kFloodToggle = 0xA0,
    kMistToggle = 0xA1,
};

enum class ByteKind : std::uint8_t {
    kText,      // belongs to a line
    kRealtime,  // a RealtimeCommand
    kDropped,   // 0x80 and above that means nothing: the first byte of a UTF-8 pair, noise
};

constexpr ByteKind byte_kind(std::uint8_t byte) noexcept
{
    if (byte == 0x18 || byte == '?' || byte == '!' || byte == '~') {
        return ByteKind::kRealtime;
    }
    if (byte < 0x80) {
        return ByteKind::kText;
    }
    const bool known = byte == 0x84 || byte == 0x85 || (byte >= 0x90 && byte <= 0x97) ||
                       (byte >= 0x99 && byte <= 0x9E) || byte == 0xA0 || byte == 0xA1;
    return known ? ByteKind::kRealtime : ByteKind::kDropped;
}

}  // namespace cusp::protocol
