// Drivers for the RP2350 of Raspberry Pi, whose Pico 2 carries it: parts of a board as hal/contract/board.hpp says.
//
//   using Player = hal::rp2350::PioPulsePlayer<hal::rp2350::Chip, Table>;    // a frame each millisecond, by PIO and DMA
//
// The image runs from RAM: sections.ld and boot.cpp copy it there, so that no step waits for the flash, and interrupts go
// on while the flash is erased. This header has the addresses of the chip's blocks (data sheet, chapters 2.2 and 3.2).
#pragma once

#include "hal/rp2350/boot_rom.hpp"
#include "hal/rp2350/chip_registers.hpp"

namespace cusp::hal::rp2350 {

// The chip as the drivers of this folder see it: a type with one function a block. Tests pass a type whose functions
// return models.
struct Chip : Core {
    static Clocks<Word>& clocks() noexcept { return block_at<Clocks<Word>>(0x40010000); }
    static PowerSequence<Word>& power_sequence() noexcept
    {
        return block_at<PowerSequence<Word>>(0x40018000);
    }
    static Resets<Word>& resets() noexcept { return block_at<Resets<Word>>(0x40020000); }
    static PinFunctions<Word>& functions() noexcept
    {
        return block_at<PinFunctions<Word>>(0x40028000);
    }
    static Pads<Word>& pads() noexcept { return block_at<Pads<Word>>(0x40038000); }
    static Crystal<Word>& crystal() noexcept { return block_at<Crystal<Word>>(0x40048000); }
    static Multiplier<Word>& core_multiplier() noexcept
    {
        return block_at<Multiplier<Word>>(0x40050000);
    }
    static Multiplier<Word>& usb_multiplier() noexcept
    {
        return block_at<Multiplier<Word>>(0x40058000);
    }
    static Uart<Word>& uart0() noexcept { return block_at<Uart<Word>>(0x40070000); }
    static Pwm<Word>& pwm() noexcept { return block_at<Pwm<Word>>(0x400A8000); }
    static Watchdog<Word>& watchdog() noexcept { return block_at<Watchdog<Word>>(0x400D8000); }
    static PowerManager<Word>& power() noexcept { return block_at<PowerManager<Word>>(0x40100000); }
    static Ticks<Word>& ticks() noexcept { return block_at<Ticks<Word>>(0x40108000); }
    static Dma<Word>& dma() noexcept { return block_at<Dma<Word>>(0x50000000); }
    static UsbMemory<Word>& usb_memory() noexcept { return block_at<UsbMemory<Word>>(0x50100000); }
    static Usb<Word>& usb() noexcept { return block_at<Usb<Word>>(0x50110000); }
    static Pio<Word>& pio0() noexcept { return block_at<Pio<Word>>(0x50200000); }
    static CorePins<Word>& core_pins() noexcept { return block_at<CorePins<Word>>(0xD0000000); }

    // The flash, by the functions of the boot ROM.
    static void erase_flash(std::uint32_t offset, std::uint32_t size) noexcept
    {
        BootRom::erase_flash(offset, size);
    }
    static void program_flash(std::uint32_t offset, const FlashPage& page) noexcept
    {
        BootRom::program_flash(offset, page);
    }
};

inline constexpr unsigned kDmaInterrupt = 10;
inline constexpr unsigned kUsbInterrupt = 14;
inline constexpr unsigned kUart0Interrupt = 33;
inline constexpr unsigned kInterruptCount = 52;

// Blocks by their bits of RESETS (7.5).
inline constexpr std::uint32_t kDmaBlock = 1U << 2U;
inline constexpr std::uint32_t kPinBlocks = 1U << 6U | 1U << 9U;
inline constexpr std::uint32_t kPio0Block = 1U << 11U;
inline constexpr std::uint32_t kCoreMultiplierBlock = 1U << 14U;
inline constexpr std::uint32_t kUsbMultiplierBlock = 1U << 15U;
inline constexpr std::uint32_t kPwmBlock = 1U << 16U;
inline constexpr std::uint32_t kUart0Block = 1U << 26U;
inline constexpr std::uint32_t kUsbBlock = 1U << 28U;

}  // namespace cusp::hal::rp2350
