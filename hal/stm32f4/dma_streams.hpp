// Streams of a DMA controller: positions of their flags (RM0090 sections 10.5.1 to 10.5.4).
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Streams 0 to 3 have the low registers, 4 to 7 the high ones; a stream's flags lie at its place.
template <class Word>
Word& stream_flags(Dma<Word>& dma, unsigned stream) noexcept
{
    return stream < 4 ? dma.lisr : dma.hisr;
}
template <class Word>
Word& stream_flag_clear(Dma<Word>& dma, unsigned stream) noexcept
{
    return stream < 4 ? dma.lifcr : dma.hifcr;
}
constexpr unsigned stream_flag_place(unsigned stream) noexcept
{
    return (stream % 4 >= 2 ? 16U : 0U) + (stream % 2) * 6U;
}

inline constexpr std::uint32_t kStreamFifoError = 1;
inline constexpr std::uint32_t kStreamDirectModeError = 4;
inline constexpr std::uint32_t kStreamTransferError = 8;
inline constexpr std::uint32_t kStreamHalf = 16;
inline constexpr std::uint32_t kStreamComplete = 32;
inline constexpr std::uint32_t kStreamAllFlags = 0x3D;

inline constexpr std::uint32_t kStreamEnable = 1U << 0U;

// Interrupts of DMA2's streams (RM0090 table 62).
constexpr unsigned dma2_interrupt(unsigned stream) noexcept
{
    return stream < 5 ? 56 + stream : 63 + stream;
}

}  // namespace cusp::hal::stm32f4
