// FlashSettings: two sectors of the flash as the settings store, which the image leaves free:
// tests/checks/image.py proves it.
//
// The core stops while the flash is busy, up to 2 s for a sector: never with frames in flight.
// Never tried on silicon. tests/unit/hal_stm32f4 runs it against a model that loses power anywhere.
#pragma once

#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Two sectors, one behind the other, and how much of each is used: what is read after a reset grows with it.
struct SettingsPlace {
    unsigned first_sector;
    std::uint32_t address;
    std::uint32_t sector_bytes;
    std::uint32_t used_bytes;
    std::uint32_t longest_erase_ms;  // data sheets, words of 32 bits
};
// The vectors lie in sector 0 and the code begins in sector 3.
struct SettingsBehindVectors {
    static constexpr SettingsPlace kPlace{1, 0x08004000, 0x4000, 0x4000, 800};
};
// The last two sectors of 512 KB, and of 1 MB: a boot loader that replaces the image leaves them alone.
struct SettingsAtEndOf512K {
    static constexpr SettingsPlace kPlace{6, 0x08040000, 0x20000, 0x8000, 2000};
};
struct SettingsAtEndOf1M {
    static constexpr SettingsPlace kPlace{10, 0x080C0000, 0x20000, 0x8000, 2000};
};

// `Place` is one of the above.
template <class Chip, class Place = SettingsBehindVectors>
class FlashSettings {
    static constexpr SettingsPlace kPlace = Place::kPlace;

public:
    // See hal/contract/board.hpp. `sector` is 0 or 1: the first of the place, or the second.
    std::uint32_t sector_size() const noexcept { return kPlace.used_bytes; }

    void read(unsigned sector, std::uint32_t offset, Span<std::uint8_t> bytes) const noexcept
    {
        for (std::uint32_t i = 0; i < bytes.size(); ++i) {
            const std::uint32_t word = Chip::read_memory(address_of(sector, (offset + i) & ~3U));
            bytes[i] = static_cast<std::uint8_t>(word >> (offset + i) % 4 * 8);
        }
    }

    bool write(unsigned sector, std::uint32_t offset, Span<const std::uint8_t> bytes) noexcept
    {
        unlock();
        bool written = wait_ready();
        Chip::flash().cr.write(kProgram | kWordWide);
        for (std::uint32_t i = 0; i + 4 <= bytes.size() && written; i += 4) {
            const std::uint32_t word = bytes[i] | static_cast<std::uint32_t>(bytes[i + 1]) << 8U |
                                       static_cast<std::uint32_t>(bytes[i + 2]) << 16U |
                                       static_cast<std::uint32_t>(bytes[i + 3]) << 24U;
            const std::uint32_t address = address_of(sector, offset + i);
            Chip::write_memory(address, word);
            written = wait_ready() && Chip::read_memory(address) == word;
        }
        lock();
        return written;
    }

    bool erase(unsigned sector) noexcept
    {
        unlock();
        bool erased = wait_ready();
        if (erased) {
            const std::uint32_t command =
                kSectorErase | kWordWide | (kPlace.first_sector + sector) << 3U;
            Chip::flash().cr.write(command);
            Chip::flash().cr.write(command | kStart);
            erased = wait_ready();
            forget_cached();
        }
        lock();
        return erased;
    }

private:
    // RM0090 section 3.9.
    static constexpr std::uint32_t kFirstKey = 0x45670123;
    static constexpr std::uint32_t kSecondKey = 0xCDEF89AB;
    static constexpr std::uint32_t kProgram = 1U << 0U;
    static constexpr std::uint32_t kSectorErase = 1U << 1U;
    static constexpr std::uint32_t kWordWide = 2U << 8U;
    static constexpr std::uint32_t kStart = 1U << 16U;
    static constexpr std::uint32_t kLock = 1U << 31U;
    static constexpr std::uint32_t kBusy = 1U << 16U;
    static constexpr std::uint32_t kErrors = 0xF2;
    // The slowest sector takes 2 s (data sheet, table 42); a round some ten cycles.
    static constexpr std::uint32_t kBusyRounds = 40000000;

    static constexpr std::uint32_t address_of(unsigned sector, std::uint32_t offset) noexcept
    {
        return kPlace.address + sector * kPlace.sector_bytes + offset;
    }
    static bool wait_ready() noexcept
    {
        auto& flash = Chip::flash();
        for (std::uint32_t round = 0; round < kBusyRounds; ++round) {
            const std::uint32_t state = flash.sr.read();
            if ((state & kBusy) == 0) {
                flash.sr.write(state & kErrors);
                return (state & kErrors) == 0;
            }
        }
        return false;
    }
    // After an erase the data cache still holds the old data (RM0090 section 3.5.2); it may be
    // flushed only while it is off. A write goes through it.
    static void forget_cached() noexcept
    {
        constexpr std::uint32_t kDataCache = 1U << 10U;
        constexpr std::uint32_t kEmptyDataCache = 1U << 12U;
        auto& access = Chip::flash().acr;
        const std::uint32_t before = access.read();
        access.write(before & ~kDataCache);
        access.write((before & ~kDataCache) | kEmptyDataCache);
        access.write(before & ~kDataCache);
        access.write(before);
    }
    static void unlock() noexcept
    {
        auto& flash = Chip::flash();
        if ((flash.cr.read() & kLock) != 0) {
            flash.keyr.write(kFirstKey);
            flash.keyr.write(kSecondKey);
        }
        // Clears error flags of an earlier write.
        flash.sr.write(kErrors);
    }
    static void lock() noexcept { Chip::flash().cr.write(kLock); }
};

}  // namespace cusp::hal::stm32f4
