// EdgeListener: every edge of the step and direction lines, one by one, in the order of the pulse trace.
#pragma once

#include <cstdint>

#include "hal/sim/simulated_player.hpp"

namespace cusp::program_run {

// Wires are step_x, dir_x, step_y, dir_y, step_z, dir_z, counted from 0. Edges of one pulse tick come by
// axes, the direction of each before its step.
class EdgeListener : public hal::FrameListener {
public:
    //   start   pulse tick of virtual time that is 0 from here on; frames before it are passed over
    //   levels  of the lines then
    EdgeListener(std::uint64_t start, PulseLines levels) : start_{start}, levels_{levels} {}

    void frame_played(std::uint64_t start_tick, const PulseFrame& frame) final;

protected:
    virtual void frame_begins(std::uint64_t /*tick*/) {}
    virtual void edge(std::uint64_t tick, unsigned wire, bool level) = 0;

    // When the last frame is over.
    std::uint64_t end() const { return end_; }

private:
    std::uint64_t start_;
    PulseLines levels_;
    std::uint64_t end_{0};
};

}  // namespace cusp::program_run
