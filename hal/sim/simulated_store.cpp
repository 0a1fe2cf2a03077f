// The flash sectors of the simulated board.
#include "hal/sim/simulated_store.hpp"

#include <algorithm>

namespace cusp::hal {
namespace {

constexpr std::uint32_t kWordSize = 4;
constexpr std::uint8_t kErased = 0xFF;

}  // namespace

SimulatedStore::SimulatedStore()
{
    for (auto& sector : sectors_) {
        sector.assign(kSectorSize, kErased);
    }
}

void SimulatedStore::read(unsigned sector,
                          std::uint32_t offset,
                          Span<std::uint8_t> bytes) const noexcept
{
    CUSP_ASSERT(sector < 2 && offset + bytes.size() <= kSectorSize);
    std::copy_n(sectors_[sector].data() + offset, bytes.size(), bytes.begin());
}

bool SimulatedStore::write(unsigned sector,
                           std::uint32_t offset,
                           Span<const std::uint8_t> bytes) noexcept
{
    CUSP_ASSERT(sector < 2 && offset + bytes.size() <= kSectorSize);
    CUSP_ASSERT(offset % kWordSize == 0 && bytes.size() % kWordSize == 0);
    for (std::uint32_t done = 0; done < bytes.size(); done += kWordSize) {
        if (!spend_word()) {
            return false;
        }
        for (std::uint32_t i = done; i < done + kWordSize; ++i) {
            // As flash does it: a write only clears bits.
            sectors_[sector][offset + i] &= bytes[i];
        }
    }
    return save();
}

bool SimulatedStore::erase(unsigned sector) noexcept
{
    CUSP_ASSERT(sector < 2);
    if (!spend_word()) {
        // The power fails amid an erase: the sector is left half done.
        std::fill_n(sectors_[sector].begin(), kSectorSize / 2, kErased);
        return false;
    }
    std::fill(sectors_[sector].begin(), sectors_[sector].end(), kErased);
    return save();
}

void SimulatedStore::damage(unsigned sector, std::uint32_t offset, std::uint8_t bits)
{
    CUSP_ASSERT(sector < 2 && offset < kSectorSize);
    sectors_[sector][offset] ^= bits;
}

bool SimulatedStore::spend_word() noexcept
{
    if (power_is_cut()) {
        return false;
    }
    if (words_left_) {
        --*words_left_;
    }
    ++words_written_;
    return true;
}

}  // namespace cusp::hal
