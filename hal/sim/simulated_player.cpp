// Virtual time of the simulated pulse player.
#include "hal/sim/simulated_player.hpp"

#include <algorithm>

namespace cusp::hal {
namespace {

// A frame has room for a thousand edges, and most have few.
void copy_edges(const PulseFrame& from, PulseFrame& to)
{
    to.edges.clear();
    std::copy(from.edges.begin(), from.edges.end(), to.edges.begin());
    to.edges.grow(from.edges.size());
}

}  // namespace

bool SimulatedPlayer::try_play(const PulseFrame& frame) noexcept
{
    if (slots_[1 - playing_].full) {
        return false;
    }
    if (underrun_ || lose_next_) {
        lose_next_ = false;
        return true;
    }
    Slot& ready = slots_[1 - playing_];
    copy_edges(frame, ready.frame);
    ready.full = true;
    return true;
}

void SimulatedPlayer::advance()
{
    Slot& played = slots_[playing_];
    const bool ready = slots_[1 - playing_].full;
    if (played.full) {
        deliver(played.frame);
    } else if (frame_number_ < 0 && !ready) {
        return;  // time starts with the first frame
    }
    ++frame_number_;
    if (!ready && last_had_edges_) {
        underrun_ = true;
        stop_with_steps_low();
    }
    played.full = false;
    playing_ = 1 - playing_;
}

std::uint64_t SimulatedPlayer::next_frame_start() const noexcept
{
    return static_cast<std::uint64_t>(frame_number_ + 1) * kPulseTicksPerFrame;
}

void SimulatedPlayer::power_off()
{
    slots_[0].full = slots_[1].full = false;
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
    const auto high = static_cast<PulseLines>(levels_ & kStepLines);
    PulseFrame last;
    if (high != 0) {
        last.edges.try_push_back({0, 0, high});
    }
    deliver(last);
    last_had_edges_ = false;
}

}  // namespace cusp::hal
