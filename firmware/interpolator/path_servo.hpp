// PathServo: how far along the path, tick by tick: as fast as the envelope, the feed and the
// acceleration allow. Its output still jumps in acceleration; the path filter makes that jerk.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/interpolator/box_filter.hpp"
#include "firmware/interpolator/min_speed_window.hpp"
#include "firmware/planner/path_queue.hpp"

namespace cusp::interpolator {

// Context: servo tick.
class PathServo {
public:
    explicit PathServo(planner::PathQueue& queue) noexcept : queue_{queue} {}

    // Precondition: at rest. `filter` is the length of the path filter in ticks.
    void reset(std::uint32_t filter) noexcept;

    struct Conditions {
        const OverrideFactors& factors;  // of squared speeds, by the overrides; all 0 holds
        // True if the present stop may be left: the filters are empty, but for the overlap that
        // the stop allows.
        bool may_pass;
        // True if it may slow down: not while a stretch before the stop still drains.
        bool may_brake;
        // Its travel one path filter ago, which leaves the filter in this tick, path units.
        std::int32_t oldest_step;
    };

    // Advances by one tick. Returns the travel in path units.
    std::int32_t tick(const Conditions& conditions) noexcept;

    // Travel since the reset, in units of 256 path units; wraps. Context: any.
    std::uint32_t travelled() const noexcept { return travelled_.load(std::memory_order_relaxed); }

    bool standing() const noexcept { return speed_ == 0; }

    // True if the last tick left a stop behind: the path filter starts anew.
    bool passed_stop() const noexcept { return passed_stop_; }

private:
    struct Bounds {
        float speed;         // mm/s, by the envelope
        float feed;          // mm/s, by feed and override
        std::uint32_t last;  // interval that counts, as counted by the queue
    };
    // The published path of one tick.
    struct Ahead {
        std::uint32_t begin;  // its first interval, as counted by the queue
        std::uint32_t published;
        const planner::Interval* first;
    };
    bool pass_intervals(Ahead& ahead, bool may_pass) noexcept;
    Bounds bounds(const Ahead& ahead,
                  float greatest,
                  const OverrideFactors& factors) const noexcept;
    float acceleration(std::uint32_t first, std::uint32_t last) const noexcept;
    float next_speed(const Ahead& ahead, const Conditions& conditions) noexcept;
    float coasting_speed(float wanted, const OverrideFactors& factors) noexcept;
    float kept_speed(float time, const OverrideFactors& factors) const noexcept;
    std::int32_t advance(const Ahead& ahead, float speed) noexcept;

    planner::PathQueue& queue_;
    std::uint32_t filter_{1};      // length of the path filter, ticks
    std::uint32_t offset_{0};      // path units into the first interval
    std::uint64_t position_{0};    // path units since the reset
    float speed_{0};               // mm/s
    float residue_{0};             // path units not yet travelled, in [0, 1)
    std::int32_t oldest_step_{0};  // of the last tick
    bool passed_stop_{false};
    std::atomic<std::uint32_t> travelled_{0};
    MinSpeedWindow speed_window_;  // last, and large: what each tick reads is near
};

}  // namespace cusp::interpolator
