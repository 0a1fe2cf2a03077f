// PathQueue: the path ahead, shared by the planner (main loop) and the interpolator (servo tick).
//
// Two views of the same path: blocks hold where it runs, plans how fast it is followed; both add up
// to the same length. The planner appends; the interpolator consumes from the front.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/planner/block.hpp"
#include "firmware/planner/law_plans.hpp"

namespace cusp::planner {

inline constexpr std::uint32_t kBlockCount = 128;
inline constexpr std::uint32_t kCurveCount = 32;

// Counters run freely; an element's place is its counter modulo the ring's size.
class PathQueue {
public:
    Block& block(std::uint32_t index) noexcept { return blocks_[index % kBlockCount]; }
    const Block& block(std::uint32_t index) const noexcept { return blocks_[index % kBlockCount]; }
    LawPlans& plans() noexcept { return plans_; }
    const LawPlans& plans() const noexcept { return plans_; }

    std::uint32_t block_begin() const noexcept { return load(block_begin_); }
    std::uint32_t block_end() const noexcept { return load(block_end_); }

    std::uint32_t free_blocks() const noexcept
    {
        return kBlockCount - (block_end() - block_begin());
    }
    std::uint32_t free_curves() const noexcept
    {
        return kCurveCount - (curve_end_ - load(curve_begin_));
    }
    // Room for the curve of the next curve block. Precondition: free_curves() > 0.
    CurveBlock& new_curve() noexcept
    {
        CurveBlock& curve = curves_[curve_end_ % kCurveCount];
        ++curve_end_;
        return curve;
    }

    // Context: main loop.
    // Room for the next block, which the servo tick does not see before append_block().
    // Precondition: free_blocks() > 0.
    Block& new_block() noexcept { return block(block_end()); }
    void append_block() noexcept;

    // Context: servo tick.
    void drop_block() noexcept
    {
        if (block(block_begin()).shape == BlockShape::kCurve) {
            store(curve_begin_, load(curve_begin_) + 1);
        }
        store(block_begin_, block_begin() + 1);
    }

    // Context: main loop, while the interpolator is at rest and does not tick.
    void clear() noexcept;

private:
    using Counter = std::atomic<std::uint32_t>;
    static std::uint32_t load(const Counter& counter) noexcept
    {
        return counter.load(std::memory_order_acquire);
    }
    static void store(Counter& counter, std::uint32_t value) noexcept
    {
        counter.store(value, std::memory_order_release);
    }

    std::array<Block, kBlockCount> blocks_{};
    std::array<CurveBlock, kCurveCount> curves_{};
    LawPlans plans_;
    Counter block_begin_{0};
    Counter block_end_{0};
    Counter curve_begin_{0};
    std::uint32_t curve_end_{0};
};

}  // namespace cusp::planner
