// SimulatedPlayer: plays pulse frames in virtual time and reports every edge to a listener.
//
// Virtual time starts with the first frame: frame k covers pulse ticks [1000 k, 1000 (k + 1)).
// Real players swap their two frames in an interrupt and make the servo tick follow it; here the
// owner of the time calls the servo tick and then advance(), once a millisecond.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"

namespace cusp::hal {

// Receives each frame when it is over.
class FrameListener {
public:
    FrameListener() = default;
    FrameListener(const FrameListener&) = delete;
    FrameListener& operator=(const FrameListener&) = delete;
    virtual ~FrameListener() = default;

    //   start_tick  of the frame, in pulse ticks of virtual time
    virtual void frame_played(std::uint64_t start_tick, const PulseFrame& frame) = 0;
};

// The contract's PulsePlayer; advance() and what follows it belong to the simulation.
class SimulatedPlayer {
public:
    bool try_play(const PulseFrame& frame) noexcept;
    bool underrun() const noexcept { return underrun_; }
    void clear_underrun() noexcept { underrun_ = false; }
    // Listeners receive lines, not pins.
    void invert(PulseLines lines) noexcept { inverted_ = lines; }
    PulseLines inverted() const noexcept { return inverted_; }

    // One servo tick passes: the playing frame is over, the ready one starts. A frame missing right
    // after one with edges is an underrun: steps are lowered, and nothing is played any more.
    void advance();

    // Listeners outlive the player or the last advance().
    void add_listener(FrameListener& listener) { listeners_.push_back(&listener); }

    // Pulse tick at which the frame that is handed over next will start.
    std::uint64_t next_frame_start() const noexcept;

    // Levels after the last frame that is over.
    PulseLines levels() const noexcept { return levels_; }

    // The power fails: frames in flight are lost and all lines fall. Time continues with the next
    // frame.
    void power_off();

    // Fault injection: the next frame is accepted and lost, as if it came too late.
    void lose_next_frame() noexcept { lose_next_ = true; }

private:
    struct Slot {
        PulseFrame frame;
        bool full{false};
    };

    void deliver(const PulseFrame& frame);
    void stop_with_steps_low();

    std::array<Slot, 2> slots_;
    unsigned playing_{0};  // the other slot is for the next frame
    // Frames since the start; the first advance() after the first frame makes it 0.
    std::int64_t frame_number_{-1};
    bool last_had_edges_{false};
    bool underrun_{false};
    bool lose_next_{false};
    PulseLines levels_{0};
    PulseLines inverted_{0};
    std::vector<FrameListener*> listeners_;
};

static_assert(is_pulse_player<SimulatedPlayer>());

}  // namespace cusp::hal
