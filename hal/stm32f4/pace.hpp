// Pace: the timer whose update requests a word of pulses each microsecond, one stream of DMA2 a port.
//
// The update itself requests from the first port's stream, compare requests from those of further
// ports. CCDS of the timer's CR2 moves these to the update (RM0090 section 17.4.2): one event. The
// streams are those of RM0090 table 43 that the serial ports leave free; RM0383 and RM0390 have them
// alike.
#pragma once

#include <array>
#include <cstdint>

#include "hal/stm32f4/dma_streams.hpp"

namespace cusp::hal::stm32f4 {

struct PaceRequest {
    unsigned stream;
    std::uint32_t channel;
    std::uint32_t enable;  // its bit of the timer's DIER
};

namespace detail {

inline constexpr std::uint32_t kUpdateRequest = 1U << 8U;
constexpr std::uint32_t compare_request(unsigned channel) noexcept { return 1U << (8U + channel); }

}  // namespace detail

template <class Chip>
struct Timer8Pace {
    static constexpr std::array<PaceRequest, 3> kRequests{{
        {1, 7, detail::kUpdateRequest},
        {3, 7, detail::compare_request(2)},
        {4, 7, detail::compare_request(3)},
    }};
    static constexpr unsigned kTimer = 8;
    static constexpr unsigned kClockBit = 1;   // of RCC_APB2ENR
    static constexpr unsigned kFreezeBit = 1;  // of DBGMCU_APB2_FZ
    static auto& timer() noexcept { return Chip::timer8(); }
};
template <class Chip>
struct Timer1Pace {
    static constexpr std::array<PaceRequest, 3> kRequests{{
        {5, 6, detail::kUpdateRequest},
        {1, 6, detail::compare_request(1)},
        {6, 6, detail::compare_request(3)},
    }};
    static constexpr unsigned kTimer = 1;
    static constexpr unsigned kClockBit = 0;
    static constexpr unsigned kFreezeBit = 0;
    static auto& timer() noexcept { return Chip::timer1(); }
};

}  // namespace cusp::hal::stm32f4
