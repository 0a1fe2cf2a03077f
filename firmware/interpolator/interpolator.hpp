// The interpolator: the path ahead becomes one set point a servo tick.
//
//   path servo: travel along the path, limited in speed and acceleration
//   path filter: a moving average of it, which limits jerk without leaving the path
//   position on the block
//   axis filters: two short moving averages an axis, for jumps of direction and curvature
//   input shaper: against vibration, where the settings ask for it
//
// Fixed work a tick, integers and float only.
#pragma once

#include "firmware/interpolator/box_filter.hpp"
#include "firmware/interpolator/path_servo.hpp"
#include "firmware/interpolator/shaper_filter.hpp"
#include "firmware/planner/planner.hpp"

namespace cusp::interpolator {

// Context: servo tick, but for reset(), set_... and hold(), resume(): main loop, any time (reset:
// at rest only).
class Interpolator {
public:
    explicit Interpolator(planner::Planner& planner) noexcept;
    Interpolator(const Interpolator&) = delete;
    Interpolator& operator=(const Interpolator&) = delete;

    // Starts at rest at `at`, filters empty, the shaper that of the planner. The planner must have
    // been reset with it.
    void reset(Position at) noexcept;

    // The next set point, machine nanometres.
    Position tick() noexcept;

    // True if nothing moves: all filters are empty.
    bool at_rest() const noexcept { return at_rest_; }

    // Feed hold: slows down on the path to a stop; at_rest() is true when it is complete.
    void hold() noexcept { holding_ = true; }
    void resume() noexcept { holding_ = false; }
    bool holding() const noexcept { return holding_; }
    // The same, as long as the servo tick says so. Context: servo tick.
    void brake(bool on) noexcept { braking_ = on; }

    // Per cent of the programmed feed, 10 to 200, and of rapids, 25 to 100.
    void set_feed_override(unsigned percent) noexcept;
    void set_rapid_override(unsigned percent) noexcept;

    // Line of the program that the tool is on; the last one while it rests at an end.
    std::uint32_t executing_line() const noexcept { return line_; }

    // The power of the move that executing_line() names; set points reach that move smoothing_ticks() later.
    path::LaserPower power() const noexcept { return power_; }
    unsigned smoothing_ticks() const noexcept
    {
        return (axis_filter_.first + axis_filter_.second - 1U) / 2U + shaper_ticks_;
    }

    // Speed along the path in this tick, mm/s.
    float speed() const noexcept;

    Position position() const noexcept { return position_; }

    // Path ahead of the servo that it may already follow, mm: where this is short and nothing is to
    // come, the planner should be closed. Context: main loop.
    float path_ahead() const noexcept
    {
        return static_cast<float>(queue_.published_length() - servo_.travelled()) * 256.0F /
               kPathUnitsPerMillimetre;
    }

private:
    static constexpr std::uint32_t kMaxAxisFilter =
        22;  // of the first; the second is one or two ticks long
    static constexpr std::uint32_t kMaxSecondFilter = 2;
    // Both sum up steps of at most 2000 mm/s.
    static_assert(kMaxAxisFilter * kMaxSecondFilter * 2000.0F * kPathUnitsPerTick < 2147483648.0F);

    // A stretch of path from stop to stop on its way through the path filter. Two overlap at a
    // corner that may be cut.
    struct Track {
        RunningSum<std::int32_t, kMaxPathFilter> filter;
        ExactDivision division;
        std::uint32_t block{0};   // that the tool is on, as counted by the queue
        std::uint32_t offset{0};  // path units into it
        PathOffset place{};       // relative to its start
    };
    void set_axis_filter(planner::AxisFilter filter) noexcept;
    PathOffset travel(Track& track, std::int32_t step) noexcept;
    PathOffset pass_blocks(Track& track, std::uint32_t offset) noexcept;
    // Never inline: ticks on one track do not pay for it.
    [[gnu::noinline]] PathOffset trail() noexcept;
    bool filters_drained() const noexcept;
    bool ready_to_go_on() noexcept;
    bool find_stop(std::uint32_t& block) const noexcept;
    void change_track() noexcept;
    void drop_passed_blocks() noexcept;

    planner::Planner& planner_;
    planner::PathQueue& queue_;
    Track* leading_{nullptr};  // of tracks_
    Track* trailing_{nullptr};
    OverrideFactors factors_{};
    Position position_{};
    PerAxis<ExactDivision> axis_division_{};
    std::int32_t along_{0};  // path units travelled in this tick
    std::uint32_t line_{0};
    unsigned shaper_ticks_{0};  // half the length of the shaper's response
    path::LaserPower power_;
    planner::AxisFilter axis_filter_{};
    bool drained_{false};         // the path filter of the leading track, before this tick
    bool drained_before_{false};  // and before the last one
    bool trail_drained_{true};    // that of the trailing track, before the last tick
    bool holding_{false};
    bool braking_{false};
    bool at_rest_{true};
    RunningSum<PathOffset, kMaxSecondFilter> second_;
    RunningSum<PathOffset, kMaxAxisFilter> first_;
    // Then what is large: what the tick reads above stays within reach of an offset.
    PathServo servo_;
    std::array<Track, 2> tracks_;
    ShaperFilter shaper_;
};

}  // namespace cusp::interpolator
