// Bits of the registers of OTG FS that its model has (RM0090 section 34.16).
#pragma once

#include <cstddef>
#include <cstdint>

namespace cusp::cosim::usb_bits {

inline constexpr std::uint32_t kReceived = 1U << 4U;
inline constexpr std::uint32_t kSuspend = 1U << 11U;
inline constexpr std::uint32_t kReset = 1U << 12U;
inline constexpr std::uint32_t kEnumerated = 1U << 13U;
inline constexpr std::uint32_t kInEvent = 1U << 18U;
inline constexpr std::uint32_t kOutEvent = 1U << 19U;
inline constexpr std::uint32_t kWakeUp = 1U << 31U;

inline constexpr std::uint32_t kActive = 1U << 15U;
inline constexpr std::uint32_t kNakStatus = 1U << 17U;
inline constexpr std::uint32_t kStall = 1U << 21U;
inline constexpr std::uint32_t kClearNak = 1U << 26U;
inline constexpr std::uint32_t kSetNak = 1U << 27U;
inline constexpr std::uint32_t kDataZero = 1U << 28U;
inline constexpr std::uint32_t kDataOne = 1U << 29U;
inline constexpr std::uint32_t kDisable = 1U << 30U;
inline constexpr std::uint32_t kEnable = 1U << 31U;

inline constexpr std::uint32_t kDone = 1;
inline constexpr std::uint32_t kDisabled = 2;
inline constexpr std::uint32_t kSetupDone = 8;

inline constexpr unsigned kOutData = 2;
inline constexpr unsigned kOutDone = 3;
inline constexpr unsigned kSetupEnd = 4;
inline constexpr unsigned kSetupData = 6;

inline constexpr std::uint32_t kFifoSpace = 0x1000;
inline constexpr std::uint32_t kSize = 0x7FFFF;

inline std::size_t words_of(std::size_t bytes) { return (bytes + 3) / 4; }

}  // namespace cusp::cosim::usb_bits
