// Addresses of the blocks of the STM32F405 (RM0090 table 1), and its interrupts (table 62).
#pragma once

#include "hal/stm32f4/registers.hpp"
#include "hal/stm32f4/usb_registers.hpp"

namespace cusp::hal::stm32f4 {

// The chip as the drivers of this folder see it: a type with one function a block. Tests pass a type
// whose functions return models.
struct Chip : Core {
    static Rcc<Word>& rcc() noexcept { return block_at<Rcc<Word>>(0x40023800); }
    static Flash<Word>& flash() noexcept { return block_at<Flash<Word>>(0x40023C00); }
    static Power<Word>& power() noexcept { return block_at<Power<Word>>(0x40007000); }
    // 'A' to 'I', as far as the chip has them.
    static Gpio<Word>& port(char letter) noexcept
    {
        return block_at<Gpio<Word>>(0x40020000 + 0x400 * static_cast<std::uintptr_t>(letter - 'A'));
    }
    static Dma<Word>& dma1() noexcept { return block_at<Dma<Word>>(0x40026000); }
    static Dma<Word>& dma2() noexcept { return block_at<Dma<Word>>(0x40026400); }
    static Timer<Word>& timer1() noexcept { return block_at<Timer<Word>>(0x40010000); }
    static Timer<Word>& timer2() noexcept { return block_at<Timer<Word>>(0x40000000); }
    static Timer<Word>& timer3() noexcept { return block_at<Timer<Word>>(0x40000400); }
    static Timer<Word>& timer4() noexcept { return block_at<Timer<Word>>(0x40000800); }
    static Timer<Word>& timer5() noexcept { return block_at<Timer<Word>>(0x40000C00); }
    static Timer<Word>& timer8() noexcept { return block_at<Timer<Word>>(0x40010400); }
    static Timer<Word>& timer9() noexcept { return block_at<Timer<Word>>(0x40014000); }
    static Timer<Word>& timer11() noexcept { return block_at<Timer<Word>>(0x40014800); }
    static Timer<Word>& timer12() noexcept { return block_at<Timer<Word>>(0x40001800); }
    static Usart<Word>& usart1() noexcept { return block_at<Usart<Word>>(0x40011000); }
    static Usart<Word>& usart2() noexcept { return block_at<Usart<Word>>(0x40004400); }
    static Usart<Word>& usart3() noexcept { return block_at<Usart<Word>>(0x40004800); }
    static UsbCore<Word>& usb() noexcept { return block_at<UsbCore<Word>>(0x50000000); }
    static Watchdog<Word>& watchdog() noexcept { return block_at<Watchdog<Word>>(0x40003000); }
    static Debug<Word>& debug() noexcept { return block_at<Debug<Word>>(0xE0042000); }
};

inline constexpr unsigned kTimer2Interrupt = 28;
inline constexpr unsigned kUsart1Interrupt = 37;
inline constexpr unsigned kUsbInterrupt = 67;
inline constexpr unsigned kInterruptCount = 82;

}  // namespace cusp::hal::stm32f4
