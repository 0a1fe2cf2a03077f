// Backlash: the play of an axis ($160 to $162), which its motor takes up where the axis turns about.
//
// From there on the motor goes the play further than the way, from rest to rest by a jerk of three levels.
// That uses kShare of the axis's acceleration and jerk and kSpeedShare of its speed; the planner has the rest,
// so that both together hold the limits. The slide lags behind the way by at most the play and kTurn, for
// the first take_up_ticks() after the turn.
//
// The first way after power-up has no play to take up: which side it is on is not known before.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::machine {

// Context: configure(), rest() and stop() main loop while no tick calls; follow() servo tick; idle() any.
class Backlash {
public:
    static constexpr float kShare = 0.25F;
    static constexpr float kSpeedShare = 0.1F;
    // An axis has turned once it has come back so far, nm: less than a step.
    static constexpr std::int64_t kTurn = 500;

    // The limits less the share of axes with play. play: mm, per axis.
    static MachineLimits left_of(const MachineLimits& limits, const AxisVecf& play) noexcept;

    // `limits`: those of the settings. What is under way is forgotten.
    void configure(const AxisVecf& play, const MachineLimits& limits) noexcept;

    // The motors are where the way is from now on, on the side of the play on which they are.
    void rest(Position at) noexcept;

    // The motors stop where they are. What is left to take up is taken up when the way goes on.
    void stop() noexcept;

    // The motors' place once the way has come to `way`.
    Position follow(Position way) noexcept;

    // Nothing is being taken up.
    bool idle() const noexcept { return !busy_.load(std::memory_order_acquire); }

    // Ticks for which a turn of the axis is taken up; 0 without play.
    std::uint32_t take_up_ticks(unsigned axis) const noexcept { return axes_[axis].length; }

private:
    struct Axis {
        std::int32_t play{0};     // nm
        std::uint32_t length{0};  // ticks
        float step{0};            // 1 / length
        std::uint32_t done{0};    // ticks of what is being taken up; 0: nothing is
        std::int32_t from{0};     // offset of the motor against the way, nm
        std::int32_t to{0};
        std::int32_t at{0};
        std::int8_t side{0};      // that the way pushes: 1 plus, -1 minus, 0 not known
        std::int8_t taken{0};     // that the motor is on, or on its way to
        std::int64_t extreme{0};  // of the way on that side
        std::int64_t way{0};      // a tick ago
    };
    static bool turns(Axis& axis, std::int64_t way) noexcept;
    static void advance(Axis& axis, std::int64_t way, bool begins) noexcept;

    PerAxis<Axis> axes_{};
    bool any_{false};
    std::atomic<bool> busy_{false};
};

}  // namespace cusp::machine
