// TimeWarp: the own time of a plan, slowed down for a hold or an override and back, within every
// limit of the axes.
//
// If the own time passes at the rate r, an axis that the plan moves with velocity V, acceleration A
// and jerk J has the velocity r V, the acceleration r^2 A + r' V and the jerk
// r^3 J + 3 r r' A + r'' V. Each constant r <= 1 is within the limits, so it is always a way out to
// let r be. The rate changes no faster than it can be let be within the known plan.
// Held by tests/unit/interpolator/time_warp_test.cpp.
#pragma once

#include "firmware/base/lane_vec.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/base/span.hpp"
#include "firmware/planner/law_cell.hpp"

namespace cusp::interpolator {

using planner::WarpBounds;

// Context: servo tick.
class TimeWarp {
public:
    void set_limits(const MachineLimits& limits) noexcept;

    // The rate that is wanted: 1 the plan's own, 0 a hold.
    void set_target(float rate) noexcept
    {
        target_ = rate;
        free_ = free_ && rate >= 1;
    }

    // Nothing moves: the rate is the one that is wanted.
    void jump() noexcept
    {
        rate_ = target_;
        slope_ = 0;
        free_ = rate_ >= 1;
    }

    // The own time that passes in a tick, s.
    //
    //   ahead  the plan from the place of the tick before on, reach() s of its own time, in pieces
    //          of a tick or more but for the second; the first is the one before that. Two at least.
    float advance(Span<const WarpBounds> ahead) noexcept;

    float reach() const noexcept { return reach_; }
    float rate() const noexcept { return rate_; }
    // True if the plan is played as it is.
    bool is_free() const noexcept { return free_; }
    bool settled() const noexcept
    {
        return !(rate_ < target_) && !(target_ < rate_) && !(slope_ < 0) && !(slope_ > 0);
    }

private:
    LaneVec acceleration_used(const WarpBounds& plan, float rate, bool brakes) const noexcept;
    float back_bend(const WarpBounds& plan, float rate, bool brakes) const noexcept;
    float wanted_slope(Span<const WarpBounds> ahead) const noexcept;
    bool may_slope(const WarpBounds& plan, float rate, float slope) const noexcept;
    float bend_left(
        const WarpBounds& plan, float rate, float slope, bool up, float part) const noexcept;
    // Pieces that may be played in a moment: the first, the last, and their ends in own time.
    struct Pass {
        std::size_t first;
        std::size_t last;
        float end_of_first;
        float end_of_last;
    };
    float bend_of_pass(Span<const WarpBounds> ahead,
                       const Pass& pass,
                       float rate,
                       float slope) const noexcept;
    bool can_let_be(Span<const WarpBounds> ahead, float slope) const noexcept;

    LaneVec ramp_{};  // a/j of each axis, s
    float longest_ramp_{0};
    float reach_{0};
    float target_{1};
    float rate_{1};
    float slope_{0};  // of the rate, 1/s
    bool free_{true};
};

}  // namespace cusp::interpolator
