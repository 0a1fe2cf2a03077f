// Frames taken apart.
#include "host_tools/program_run/edge_listener.hpp"

#include "firmware/base/axis.hpp"

namespace cusp::program_run {

void EdgeListener::frame_played(std::uint64_t start_tick, const PulseFrame& frame)
{
    // A frame that was in flight before the trace began is not of it.
    if (start_tick < start_) {
        return;
    }
    const std::uint64_t tick = start_tick - start_;
    frame_begins(tick);
    for (const PulseEdge& at : frame.edges) {
        const auto now = static_cast<PulseLines>((levels_ | at.raise) & ~unsigned{at.lower});
        const auto changed = static_cast<PulseLines>(now ^ levels_);
        levels_ = now;
        for (unsigned axis = 0; changed != 0 && axis < kAxisCount; ++axis) {
            if ((changed & direction_line(axis)) != 0) {
                edge(tick + at.tick, 2 * axis + 1, (now & direction_line(axis)) != 0);
            }
            if ((changed & step_line(axis)) != 0) {
                edge(tick + at.tick, 2 * axis, (now & step_line(axis)) != 0);
            }
        }
    }
    end_ = tick + kPulseTicksPerFrame;
}

}  // namespace cusp::program_run
