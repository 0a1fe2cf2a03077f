// Virtual time of the simulated pulse player.
#include "hal/sim/simulated_player.hpp"

namespace cusp::hal {

bool SimulatedPlayer::try_play(const PulseFrame& frame) noexcept
{
    if (ready_.full) {
        return false;
    }
    if (underrun_ || lose_next_) {
        lose_next_ = false;
        return true;
    }
    ready_.frame = frame;
    ready_.full = true;
    return true;
}

void SimulatedPlayer::advance()
{
    if (playing_.full) {
        deliver(playing_.frame);
    } else if (frame_number_ < 0 && !ready_.full) {
        return;  // time starts with the first frame
    }
    ++frame_number_;
    if (!ready_.full && last_had_edges_) {
        underrun_ = true;
        stop_with_steps_low();
    }
    playing_.full = ready_.full;
    if (ready_.full) {
        playing_.frame = ready_.frame;
    }
    ready_.full = false;
}

std::uint64_t SimulatedPlayer::next_frame_start() const noexcept
{
    return static_cast<std::uint64_t>(frame_number_ + 1) * kPulseTicksPerFrame;
}

void SimulatedPlayer::power_off()
{
    playing_.full = ready_.full = false;
    underrun_ = false;
    stop_with_steps_low();
}

void SimulatedPlayer::deliver(const PulseFrame& frame)
{
    const auto start = static_cast<std::uint64_t>(frame_number_) * kPulseTicksPerFrame;
    last_had_edges_ = !frame.edges.empty();
    for (const PulseEdge& edge : frame.edges) {
        levels_ = static_cast<PulseLines>((levels_ | edge.raise) & ~unsigned{edge.lower});
    }
    for (FrameListener* listener : listeners_) {
        listener->frame_played(start, frame);
    }
}

void SimulatedPlayer::stop_with_steps_low()
{
    const PulseLines steps = step_line(0) | step_line(1) | step_line(2);
    const auto high = static_cast<PulseLines>(levels_ & steps);
    PulseFrame last;
    if (high != 0) {
        last.edges.try_push_back({0, 0, high});
    }
    deliver(last);
    last_had_edges_ = false;
}

}  // namespace cusp::hal
