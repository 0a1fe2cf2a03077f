// MinSpeedWindow: the least speed allowed anywhere over the travel of one path filter ahead.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/planner/path_queue.hpp"

namespace cusp::interpolator {

// Overrides as factors of squared speeds, by the kind of move. All 0 holds.
struct OverrideFactors {
    std::array<float, path::kMoveKinds> factors{1, 1, 1};

    float of(path::MoveKind kind) const noexcept { return factors[static_cast<std::size_t>(kind)]; }
    void set(path::MoveKind kind, float factor) noexcept
    {
        factors[static_cast<std::size_t>(kind)] = factor;
    }
};

// Squared speed from which braking reaches what both envelopes allow at the end of the interval and
// beyond, `distance` mm before that end.
float braking_before_end(const planner::Interval& interval,
                         float distance,
                         const OverrideFactors& factors) noexcept;

// Squared speed allowed in the interval by its caps.
float cap_of(const planner::Interval& interval, const OverrideFactors& factors) noexcept;

// A window that only moves forward, with the minimum over it: a queue of ends of intervals in
// rising order of their speeds. Context: servo tick.
class MinSpeedWindow {
public:
    // Starts over at an interval, `distance` path units being left of it.
    void restart(std::uint32_t interval, std::uint64_t end_position) noexcept;
    bool started() const noexcept { return started_; }
    std::uint32_t interval() const noexcept { return interval_; }

    // Least squared speed allowed between two positions along the path, path units. 0 where the
    // window reaches over more intervals than one tick may read; the next ticks continue from
    // there.
    float least_between(const planner::PathQueue& queue,
                        std::uint64_t from,
                        std::uint64_t to,
                        const OverrideFactors& factors) noexcept;

private:
    // The position in halves: a whole one of 64 bits would leave four bytes of each entry unused.
    struct Entry {
        std::uint32_t low;
        std::uint32_t high;
        float speed;  // squared

        std::uint64_t position() const noexcept { return std::uint64_t{high} << 32U | low; }
    };
    static constexpr std::uint32_t kEntries = 64;
    static constexpr std::uint32_t kIntervalsPerTick = 48;

    void push(std::uint64_t position, float speed) noexcept;

    std::array<Entry, kEntries> entries_{};
    std::uint32_t begin_{0};
    std::uint32_t end_{0};
    std::uint32_t interval_{0};
    std::uint64_t interval_end_{0};  // position
    bool started_{false};
};

}  // namespace cusp::interpolator
