// Motion: planner, interpolator and pulses as one object that takes moves and makes frames.
//
// The servo tick may interrupt the main loop at any instruction, never the other way round. A gate
// protects critical sections of the main loop: while it is shut, ticks advance nothing.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "firmware/base/pulse_frame.hpp"
#include "firmware/interpolator/interpolator.hpp"
#include "firmware/machine/backlash.hpp"
#include "firmware/machine/input_filter.hpp"
#include "firmware/machine/laser.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/machine/stops.hpp"
#include "firmware/planner/planner.hpp"
#include "firmware/pulse/pulse_maker.hpp"

namespace cusp::machine {

// The condition that stops motion: an input that comes on, or goes off.
struct Watch {
    std::uint16_t inputs{0};  // any of these
    bool off{false};          // goes off
    bool filtered{false};     // through the filter of $790, for switches; probes answer at once
};

// The motors that step, of an axis with two of them: its own, and the fourth.
enum class Motors : std::uint8_t { kBoth, kFirst, kFourth };

class Motion {
public:
    // `queue` must outlive this.
    Motion(planner::PathQueue& queue, const Settings& settings) noexcept;

    // Main loop.

    bool has_room() const noexcept { return planner_.has_room(); }
    // Precondition: has_room(), and move.start == tail().
    void push(const path::Move& move) noexcept;
    // No move follows for now.
    void close() noexcept;
    // The begin of a slice of the main loop: lets the planner go on with its moves; closes the path
    // where it runs out and nothing came for a while. more_waits: lines are at hand.
    void work(bool more_waits) noexcept;
    // The end of a slice: gives the planner what was pushed and closed in it. True if it has more to do
    // before anything moves on.
    bool take_changes() noexcept;

    Position tail() const noexcept { return planner_.tail(); }
    // The last set point.
    Position position() const noexcept;
    std::uint32_t free_blocks() const noexcept { return planner_.free_blocks(); }
    std::uint32_t executing_line() const noexcept { return interpolator_.executing_line(); }
    float speed() const noexcept { return interpolator_.speed(); }  // mm/s

    // Nothing moves just now: a hold is complete, or there is nothing to do.
    bool at_rest() const noexcept { return interpolator_.at_rest() && backlash_.idle(); }
    // Every move is done.
    bool finished() const noexcept { return planner_.empty() && at_rest(); }
    // As above, and the last pulse is made.
    bool settled() const noexcept { return finished() && pulses_.idle(); }

    void hold() noexcept { interpolator_.hold(); }
    // A move that its watch has stopped stays where it is.
    void resume() noexcept;
    void set_overrides(unsigned feed_percent, unsigned rapid_percent) noexcept;

    // Discards all moves and stays at the last set point: after a hold, or at once after a
    // fault.
    void abandon() noexcept;
    // Frames were made and not played: motion has ended at once, and there is none until abandon(). The
    // position is lost by some milliseconds of travel.
    void lose_frames() noexcept;
    // Sets the machine's position without motion. Precondition: settled().
    void relocate(Position at) noexcept;
    // Precondition: settled().
    void configure(const Settings& settings) noexcept;

    // Lets both motors of the axis that has two step, or one alone, as long as homing squares it.
    // Precondition: settled(), or the position is lost.
    void drive(Motors motors) noexcept;

    // Stops softly once the watch answers; clears the contact before.
    void watch(Watch watch) noexcept;
    void unwatch() noexcept { watched_.store(0, std::memory_order_release); }
    // Position of the machine when the watch answered.
    std::optional<Position> contact() const noexcept;
    // Which of the watched inputs answered then.
    std::uint16_t contact_inputs() const noexcept { return contact_inputs_; }
    // The position at which another of them answered before the machine came to rest.
    std::optional<Position> later_contact() const noexcept;

    // While on, any limit switch stops everything within the tick.
    void guard_limits(bool on) noexcept { guarding_.store(on, std::memory_order_relaxed); }
    // True if that happened; there is no motion until abandon().
    bool limit_hit() const noexcept { return limit_hit_.load(std::memory_order_acquire); }
    // True if a stop has ended motion at once; there is none until abandon(), either.
    bool halted() const noexcept { return halted_.load(std::memory_order_acquire); }

    // The power of the beam, tick by tick.
    Laser& laser() noexcept { return laser_; }
    const Laser& laser() const noexcept { return laser_; }

    const InputFilter& inputs() const noexcept { return inputs_; }
    // The stops that act in the tick, whatever the main loop does.
    Stops& stops() noexcept { return stops_; }
    const Stops& stops() const noexcept { return stops_; }
    // Servo ticks since power-up: the only clock there is. Wraps.
    std::uint32_t ticks() const noexcept { return ticks_.load(std::memory_order_acquire); }

    // Servo tick.

    void tick(std::uint16_t raw_inputs, PulseFrame& frame) noexcept;

private:
    void sample(std::uint16_t raw_inputs) noexcept;
    // Position of the machine when an input began to answer, and for how long it has.
    struct Answer {
        Position at{};
        std::uint8_t ticks{0};
    };
    // True if one of these inputs has answered long enough.
    bool answered(Answer& answer, unsigned inputs) noexcept;
    void check_watch() noexcept;
    void put_motors(Position at) noexcept;
    void stand_still(bool on) noexcept { stands_still_.store(on, std::memory_order_release); }

    planner::Planner planner_;
    interpolator::Interpolator interpolator_{planner_};
    pulse::PulseMaker pulses_;
    Backlash backlash_;
    InputFilter inputs_;
    Stops stops_;
    Laser laser_;

    Position set_point_{};
    // A tick ago. At the begin of a tick the frame that plays begins there: two are in flight.
    Position played_{};
    Position motors_{};  // the set point, and what play has been taken up
    Answer contact_{};
    Answer later_contact_{};
    std::uint16_t contact_inputs_{0};
    std::uint16_t inverted_inputs_{0};
    std::uint16_t used_inputs_{0};
    std::uint8_t filter_ticks_{0};
    bool watch_off_{false};
    bool watch_filtered_{false};
    std::atomic<std::uint16_t> watched_{0};
    std::atomic<bool> contacted_{false};
    std::atomic<bool> contacted_later_{false};
    std::atomic<bool> guarding_{false};
    std::atomic<bool> limit_hit_{false};
    std::atomic<bool> halted_{false};
    std::atomic<bool> gate_shut_{false};
    std::atomic<bool> stands_still_{false};  // no pulses either: their position is being changed
    std::atomic<std::uint32_t> ticks_{0};

    float least_acceleration_{1};
    float path_filter_s_{0};
    std::uint32_t last_push_tick_{0};
    bool open_{false};
    bool changed_{false};  // pushed to or closed in this slice
    bool plans_{false};    // the planner has more to do
    std::optional<unsigned> second_motor_axis_;
};

}  // namespace cusp::machine
