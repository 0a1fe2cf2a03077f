// Functions of the RP2350's boot ROM (data sheet, 5.4): the flash can't be read while it is written, so that what
// writes it lies elsewhere.
#pragma once

#include <array>
#include <cstdint>

#include "hal/cortex_m/cortex_m.hpp"

namespace cusp::hal::rp2350 {

inline constexpr std::uint32_t kFlashAddress = 0x10000000;
inline constexpr std::uint32_t kFlashSector = 4096;
using FlashPage = std::array<std::uint8_t, 256>;  // what is programmed at once

// Precondition of both: nothing that runs meanwhile, interrupts too, lies in the flash.
class BootRom {
public:
    // `offset` and `size` are multiples of kFlashSector.
    static void erase_flash(std::uint32_t offset, std::uint32_t size) noexcept
    {
        constexpr std::uint32_t kBlock = 1U << 16U;
        constexpr std::uint32_t kBlockErase = 0xD8;
        begin();
        find<void (*)(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t)>('R', 'E')(
            offset, size, kBlock, kBlockErase);
        end();
    }
    // `offset` is a multiple of a page.
    static void program_flash(std::uint32_t offset, const FlashPage& page) noexcept
    {
        begin();
        find<void (*)(std::uint32_t, const std::uint8_t*, std::uint32_t)>('R', 'P')(
            offset, page.data(), static_cast<std::uint32_t>(page.size()));
        end();
    }

private:
    // A function by its two letters; the ROM's own search is found at a fixed place.
    template <class Function>
    static Function find(char first, char second) noexcept
    {
        using Search = std::uintptr_t (*)(std::uint32_t, std::uint32_t);
        constexpr std::uint32_t kForSecureArm = 4;
        // The upper half of this word. The compiler takes whatever lies so low for a mistake.
        std::uintptr_t place = 0x14;
        __asm volatile("" : "+r"(place));
        const std::uint32_t word = cortex_m::block_at<cortex_m::DeviceWord>(place).read();
        const auto search = reinterpret_cast<Search>(static_cast<std::uintptr_t>(word >> 16U));
        const auto code = static_cast<std::uint32_t>(static_cast<std::uint8_t>(first)) |
                          static_cast<std::uint32_t>(static_cast<std::uint8_t>(second)) << 8U;
        return reinterpret_cast<Function>(search(code, kForSecureArm));
    }
    static void call(char first, char second) noexcept { find<void (*)()>(first, second)(); }
    static void begin() noexcept
    {
        call('I', 'F');  // the flash's pins
        call('E', 'X');  // from reading in place to commands
    }
    static void end() noexcept
    {
        call('F', 'C');  // what the cache holds is old
        call('C', 'X');  // back, by the plainest command: only settings are read from now on
    }
};

}  // namespace cusp::hal::rp2350
