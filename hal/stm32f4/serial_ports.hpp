// The USARTs that may be a board's serial line, or its spindle's, with their streams, interrupts and pins.
#pragma once

#include <cstdint>

#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/dma_streams.hpp"
#include "hal/stm32f4/peripheral_clocks.hpp"
#include "hal/stm32f4/pins.hpp"

namespace cusp::hal::stm32f4 {

// RM0090 tables 42 and 43: all by channel 4.
template <class Chip>
struct Usart1Port {
    static auto& usart() noexcept { return Chip::usart1(); }
    static auto& dma() noexcept { return Chip::dma2(); }
    static constexpr unsigned kReceiveStream = 2;
    static constexpr unsigned kSendStream = 7;
    static constexpr unsigned kInterrupt = kUsart1Interrupt;
    static constexpr unsigned kSendInterrupt = dma2_interrupt(kSendStream);
    static constexpr Pin kTransmit{'A', 9};
    static constexpr Pin kReceive{'A', 10};
    static constexpr PeripheralClocks kClocks{1U << 22U, 0, 1U << 4U};
    static constexpr bool kOnFastBus = true;
};
template <class Chip>
struct Usart2Port {
    static auto& usart() noexcept { return Chip::usart2(); }
    static auto& dma() noexcept { return Chip::dma1(); }
    static constexpr unsigned kReceiveStream = 5;
    static constexpr unsigned kSendStream = 6;
    static constexpr unsigned kInterrupt = 38;
    static constexpr unsigned kSendInterrupt = 17;  // DMA1 stream 6
    static constexpr Pin kTransmit{'A', 2};
    static constexpr Pin kReceive{'A', 3};
    static constexpr PeripheralClocks kClocks{1U << 21U, 1U << 17U, 0};
    static constexpr bool kOnFastBus = false;
};
template <class Chip>
struct Usart3Port {
    static auto& usart() noexcept { return Chip::usart3(); }
    static auto& dma() noexcept { return Chip::dma1(); }
    static constexpr unsigned kReceiveStream = 1;
    static constexpr unsigned kSendStream = 3;
    static constexpr unsigned kInterrupt = 39;
    static constexpr unsigned kSendInterrupt = 14;  // DMA1 stream 3
    static constexpr Pin kTransmit{'D', 8};
    static constexpr Pin kReceive{'D', 9};
    static constexpr PeripheralClocks kClocks{1U << 21U, 1U << 18U, 0};
    static constexpr bool kOnFastBus = false;
};

}  // namespace cusp::hal::stm32f4
