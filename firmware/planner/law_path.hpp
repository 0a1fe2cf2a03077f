// LawPath: the blocks of a stretch from stop to stop, in order, as the time law reads them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/planner/block.hpp"

namespace cusp::planner {

inline constexpr std::uint32_t kLawBlocks = 96;  // of a ring of kBlockCount

struct LawBlock {
    const Block* block;
    float feed;  // squared, (mm/s)^2
    float
        centripetal;  // mm/s^2, most for which the filters leave the path by no more than they may
    std::uint8_t percent{100};  // of the programmed feed
};

// A block and where it begins, path units from the start of the stretch.
struct PathCursor {
    std::uint32_t block{0};
    std::int64_t begin{0};
};

// Context: main loop.
class LawPath {
public:
    bool full() const noexcept { return end_ - begin_.block >= kLawBlocks; }

    // Precondition: !full(), !closed(). The block must stay where it is until it is dropped.
    void append(const Block& block) noexcept;
    // The path stops at the end of the last block.
    void close() noexcept { closed_ = true; }
    bool closed() const noexcept { return closed_; }

    // No place before the cursor's block is asked for any more.
    void drop_before(const PathCursor& cursor) noexcept { begin_ = cursor; }
    void clear() noexcept { *this = LawPath{}; }

    // Path units from the start of the stretch to the end of the last block.
    std::int64_t length() const noexcept { return length_; }
    std::uint32_t end() const noexcept { return end_; }
    const PathCursor& begin() const noexcept { return begin_; }
    LawBlock operator[](std::uint32_t index) const noexcept
    {
        const Block* block = blocks_[index % kRing];
        return {block, block->feed, block->centripetal, block->percent};
    }

    // Moves the cursor to the block that holds a place.
    //
    //   at    path units from the start of the stretch.
    //   left  at a joint: the end of the block before it instead of the start of the next.
    void seek(PathCursor& cursor, std::int64_t at, bool left = false) const noexcept;

    // The derivatives by arc length at a place, on the side that seek() has chosen.
    LaneDerivatives derivatives(const PathCursor& cursor, std::int64_t at) const noexcept;

private:
    static constexpr std::uint32_t kRing = 128;  // a power of two: counters run freely
    std::array<const Block*, kRing> blocks_{};
    PathCursor begin_{};
    std::uint32_t end_{0};
    std::int64_t length_{0};
    bool closed_{false};
};

// mm. Precondition: less than 2^31 path units.
inline float to_mm(std::int64_t path_units) noexcept
{
    return static_cast<float>(static_cast<std::int32_t>(path_units)) / kPathUnitsPerMillimetre;
}

// To the nearest; of a length that is not negative.
inline std::int64_t to_units(float mm) noexcept
{
    return static_cast<std::int64_t>(mm * kPathUnitsPerMillimetre + 0.5F);
}

// mm between two places; far is far.
inline float distance(std::int64_t from, std::int64_t to) noexcept
{
    constexpr std::int64_t kFar = 2'000'000'000;
    return to_mm(std::clamp(to - from, -kFar, kFar));
}

}  // namespace cusp::planner
