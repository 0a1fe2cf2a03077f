// MemorySettings: the settings store in memory, lost when the program ends.
#pragma once

#include <array>
#include <cstdint>

#include "hal/contract/board.hpp"

namespace cusp::hal::qemu {

class MemorySettings {
public:
    MemorySettings() noexcept
    {
        for (auto& sector : sectors_) {
            sector.fill(kErased);
        }
    }

    // See hal/contract/board.hpp.
    std::uint32_t sector_size() const noexcept { return kSectorSize; }
    void read(unsigned sector, std::uint32_t offset, Span<std::uint8_t> bytes) const noexcept
    {
        for (std::uint32_t i = 0; i < bytes.size(); ++i) {
            bytes[i] = sectors_[sector][offset + i];
        }
    }
    bool write(unsigned sector, std::uint32_t offset, Span<const std::uint8_t> bytes) noexcept
    {
        for (std::uint32_t i = 0; i < bytes.size(); ++i) {
            // As flash does it: a write only clears bits.
            sectors_[sector][offset + i] =
                static_cast<std::uint8_t>(sectors_[sector][offset + i] & bytes[i]);
        }
        return true;
    }
    bool erase(unsigned sector) noexcept
    {
        sectors_[sector].fill(kErased);
        return true;
    }

private:
    // The chip's have 16 KB; room for a few records suffices for tests.
    static constexpr std::uint32_t kSectorSize = 4096;
    static constexpr std::uint8_t kErased = 0xFF;

    std::array<std::array<std::uint8_t, kSectorSize>, 2> sectors_;
};

}  // namespace cusp::hal::qemu
