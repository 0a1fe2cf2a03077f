// FlashSettings: the last two sectors of the flash as the settings store, which the image leaves free:
// tests/checks/image.py proves it.
//
// The main loop stops while the flash is busy, up to 0.4 s for a sector; interrupts and the servo tick go on.
// Never tried on silicon. tests/unit/hal_rp2350 runs it against a model that loses power anywhere.
#pragma once

#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/rp2350/boot_rom.hpp"
#include "hal/rp2350/chip_registers.hpp"

namespace cusp::hal::rp2350 {

// `kFlashBytes`: of the board's flash.
template <class Chip, std::uint32_t kFlashBytes>
class FlashSettings {
public:
    static constexpr std::uint32_t kOffset = kFlashBytes - 2 * kFlashSector;
    static constexpr std::uint32_t kAddress = kFlashAddress + kOffset;

    // See hal/contract/board.hpp. `sector` is 0 or 1.
    std::uint32_t sector_size() const noexcept { return kFlashSector; }

    void read(unsigned sector, std::uint32_t offset, Span<std::uint8_t> bytes) const noexcept
    {
        for (std::uint32_t i = 0; i < bytes.size(); ++i) {
            const std::uint32_t at = kAddress + sector * kFlashSector + offset + i;
            bytes[i] = static_cast<std::uint8_t>(Chip::read_memory(at & ~3U) >> at % 4 * 8);
        }
    }

    // Pages are written as a whole; where a page has more than these bytes, what is written to the rest is 0xFF, which
    // changes nothing.
    bool write(unsigned sector, std::uint32_t offset, Span<const std::uint8_t> bytes) noexcept
    {
        std::uint32_t done = 0;
        while (done < bytes.size()) {
            FlashPage page;
            page.fill(0xFF);
            const auto size = static_cast<std::uint32_t>(page.size());
            const std::uint32_t begin = (offset + done) % size;
            const std::uint32_t first = done;
            for (std::uint32_t i = begin; i < size && done < bytes.size(); ++i) {
                page[i] = bytes[done];
                ++done;
            }
            Chip::program_flash(kOffset + sector * kFlashSector + offset + first - begin, page);
            if (!holds(sector, offset + first, {&bytes[first], done - first})) {
                return false;
            }
        }
        return true;
    }

    bool erase(unsigned sector) noexcept
    {
        Chip::erase_flash(kOffset + sector * kFlashSector, kFlashSector);
        for (std::uint32_t offset = 0; offset < kFlashSector; offset += 4) {
            if (Chip::read_memory(kAddress + sector * kFlashSector + offset) != 0xFFFFFFFFU) {
                return false;
            }
        }
        return true;
    }

private:
    bool holds(unsigned sector, std::uint32_t offset, Span<const std::uint8_t> bytes) const noexcept
    {
        for (std::uint32_t i = 0; i < bytes.size(); ++i) {
            std::uint8_t byte = 0;
            read(sector, offset + i, {&byte, 1});
            if (byte != bytes[i]) {
                return false;
            }
        }
        return true;
    }
};

}  // namespace cusp::hal::rp2350
