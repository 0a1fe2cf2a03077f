// SimulatedStore: two sectors of flash in memory, optionally kept in a file, with simulated power
// cuts.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/contract/board.hpp"

namespace cusp::hal {

// The contract's SettingsStore; members after it belong to the simulation.
class SimulatedStore {
public:
    static constexpr std::uint32_t kSectorSize = 16 * 1024;

    SimulatedStore();

    std::uint32_t sector_size() const noexcept { return kSectorSize; }
    void read(unsigned sector, std::uint32_t offset, Span<std::uint8_t> bytes) const noexcept;
    bool write(unsigned sector, std::uint32_t offset, Span<const std::uint8_t> bytes) noexcept;
    bool erase(unsigned sector) noexcept;

    // Loads the sectors from this file, if it exists, and keeps them in it from now on. A file of
    // another size is refused.
    //
    // Returns false where the file can't be read or written.
    bool keep_in(const std::string& file);

    // Fault injection: after this many more words (an erased sector counts as one) the power fails;
    // from then on every write fails. None: never.
    void cut_power_after(std::optional<std::uint64_t> words) noexcept { words_left_ = words; }
    bool power_is_cut() const noexcept { return words_left_ && *words_left_ == 0; }
    // Words written and sectors erased so far.
    std::uint64_t words_written() const noexcept { return words_written_; }

    // Fault injection: flips bits of one byte.
    void damage(unsigned sector, std::uint32_t offset, std::uint8_t bits);

private:
    bool spend_word() noexcept;
    bool save() const { return !keep_ || keep_(sectors_); }

    using Sectors = std::array<std::vector<std::uint8_t>, 2>;

    Sectors sectors_;
    std::optional<std::uint64_t> words_left_;
    std::uint64_t words_written_{0};
    // Writes all sectors to a file; none: they are kept nowhere.
    std::function<bool(const Sectors&)> keep_;
};

static_assert(is_settings_store<SimulatedStore>());

}  // namespace cusp::hal
