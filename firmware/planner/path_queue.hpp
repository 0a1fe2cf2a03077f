// PathQueue: the path ahead, shared by the planner (main loop) and the interpolator (servo tick).
//
// Two views of the same path: blocks hold where it runs, intervals how fast it may be followed;
// both add up to the same length. The planner appends; the interpolator consumes from the front.
// Intervals up to published() are final except that their envelope may still rise.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/planner/block.hpp"
#include "firmware/planner/speed_limit.hpp"

namespace cusp::planner {

// The speed limit of a stretch of path, and the envelope of speeds from which the machine can
// always brake. Speeds are squared. d mm before the end of the stretch the envelope is
// min(limit.cap, end_speed + 2 slope d).
struct Envelope {
    SpeedLimit limit;
    float end_speed;  // squared, at the end
    float slope;      // braking, mm/s^2
    // For the feed alone: min(limit.feed, feed_end + 2 slope d). An override scales
    // the part of it that stems from a programmed feed, feed_origin.
    float feed_end;
    float feed_origin;
};

// A stretch of path.
struct Interval {
    std::uint32_t length;      // path units
    std::uint32_t least_time;  // units of 0.1 us, to pass at the greatest speed
    union {
        Allowance allowance;  // until published
        Envelope envelope;    // from then on
    };
    bool stop_at_end;      // the path filter drains there before the path continues,
    std::uint8_t overlap;  // but for so many ticks
    path::MoveKind kind;
    path::MoveKind origin_kind;  // of the move that feed_origin is from
};

inline constexpr std::uint32_t kBlockCount = 256;
inline constexpr std::uint32_t kIntervalCount = 512;
inline constexpr std::uint32_t kCurveCount = 32;

// Counters run freely; an element's place is its counter modulo the ring's size.
class PathQueue {
public:
    Block& block(std::uint32_t index) noexcept { return blocks_[index % kBlockCount]; }
    const Block& block(std::uint32_t index) const noexcept { return blocks_[index % kBlockCount]; }
    Interval& interval(std::uint32_t index) noexcept { return intervals_[index % kIntervalCount]; }
    const Interval& interval(std::uint32_t index) const noexcept
    {
        return intervals_[index % kIntervalCount];
    }

    std::uint32_t block_begin() const noexcept { return load(block_begin_); }
    std::uint32_t block_end() const noexcept { return load(block_end_); }
    std::uint32_t interval_begin() const noexcept { return load(interval_begin_); }
    std::uint32_t published() const noexcept { return load(published_); }
    std::uint32_t interval_end() const noexcept { return interval_end_; }

    std::uint32_t free_blocks() const noexcept
    {
        return kBlockCount - (block_end() - block_begin());
    }
    std::uint32_t free_intervals() const noexcept
    {
        return kIntervalCount - (interval_end() - interval_begin());
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

    // Length of all that was published since clear(), in units of 256 path units; wraps after 68 m.
    std::uint32_t published_length() const noexcept
    {
        return static_cast<std::uint32_t>(published_length_ >> 8U);
    }
    void add_published_length(std::uint32_t path_units) noexcept
    {
        published_length_ += path_units;
    }

    // Half the length of the path filter, s. Set before the first move.
    float half_filter() const noexcept { return half_filter_; }
    void set_half_filter(float seconds) noexcept { half_filter_ = seconds; }

    // Context: main loop.
    // Room for the next block, which the servo tick does not see before append_block().
    // Precondition: free_blocks() > 0.
    Block& new_block() noexcept { return block(block_end()); }
    void append_block() noexcept;
    void append_interval(const Interval& interval) noexcept;
    void insert_interval(std::uint32_t before, const Interval& interval) noexcept;
    void publish(std::uint32_t end) noexcept { store(published_, end); }

    // Notes that the envelope of intervals from `first` on has risen.
    void note_change(std::uint32_t first) noexcept
    {
        const std::uint32_t begin = interval_begin();
        if (first - begin < changed_from_.load(std::memory_order_relaxed) - begin) {
            changed_from_.store(first, std::memory_order_relaxed);
        }
    }

    // Context: servo tick.
    // The first interval whose envelope rose since the last call; far ahead where none did.
    std::uint32_t take_changed_from() noexcept
    {
        const std::uint32_t first = changed_from_.load(std::memory_order_relaxed);
        changed_from_.store(interval_begin() - 1, std::memory_order_relaxed);
        return first;
    }
    void drop_block() noexcept
    {
        if (block(block_begin()).shape == BlockShape::kCurve) {
            store(curve_begin_, load(curve_begin_) + 1);
        }
        store(block_begin_, block_begin() + 1);
    }
    void drop_interval() noexcept { store(interval_begin_, interval_begin() + 1); }

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
    std::array<Interval, kIntervalCount> intervals_{};
    Counter block_begin_{0};
    Counter block_end_{0};
    Counter curve_begin_{0};
    std::uint32_t curve_end_{0};
    Counter interval_begin_{0};
    Counter published_{0};
    Counter changed_from_{0};
    std::uint32_t interval_end_{0};
    std::uint64_t published_length_{0};
    float half_filter_{0};
};

}  // namespace cusp::planner
