// RepetitionSearch: finds repetitions in a run at any distance: layers of roughing, passes of equal shape. The window
// of deflate is 32 kB, some seconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "firmware/base/axis.hpp"

namespace cusp::view {

// Ticks [first, first + count) have the differences of the ticks `distance` before them.
struct Repetition {
    std::size_t first;
    std::size_t count;
    std::size_t distance;
};

class RepetitionSearch {
public:
    // Shorter repetitions are not found.
    static constexpr std::size_t kShortest = 64;

    // The compared values of the next tick; ticks count from 0.
    void add(const std::array<std::uint64_t, kLinearAxes>& differences);

    // Repetitions within ticks [begin, end), in order, without overlap, of ticks that are in [begin, end) or in the
    // range of an earlier call. A repetition may overlap its original.
    // Precondition: end ticks were added.
    std::vector<Repetition> find(std::size_t begin, std::size_t end);

private:
    using Differences = std::array<std::uint32_t, kLinearAxes>;
    // Larger differences are not compared.
    static constexpr std::uint32_t kHuge = std::numeric_limits<std::uint32_t>::max();
    // Every kStep-th start is stored.
    static constexpr std::size_t kStep = 16;
    static constexpr unsigned kTableBits = 20;
    static constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

    bool equal(std::size_t a, std::size_t b) const;
    std::uint32_t& place_of(std::uint64_t hash)
    {
        return table_[hash * 0x9E3779B97F4A7C15U >> (64 - kTableBits)];
    }
    // Hashes of the kShortest ticks from each tick in [begin, end - kShortest].
    std::vector<std::uint64_t> hashes(std::size_t begin, std::size_t end) const;

    std::vector<Differences> ticks_;
    std::vector<std::uint32_t> table_ = std::vector<std::uint32_t>(1U << kTableBits, kNowhere);
};

}  // namespace cusp::view
