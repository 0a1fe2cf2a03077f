// EdgeListener: receives every edge of the step and direction lines in the order of the pulse trace.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/axis.hpp"
#include "hal/sim/simulated_player.hpp"

namespace cusp::program_run {

// The lines of so many axes, X first. A second motor has the lines of A and is not traced.
constexpr unsigned traced_lines(unsigned axes) { return axes > kLinearAxes ? 0xFFU : 0x3FU; }

// Wires are step_x, dir_x, step_y, dir_y, step_z, dir_z and those of A, counted from 0. Edges of one pulse tick
// are ordered by axis, the direction of each before its step.
//
// `Own` is the derived class (CRTP). It has edge(tick, wire, level), called for each edge, and may have
// frame_begins(tick). No virtual call: a second of machine time has some 10^5 edges.
template <class Own>
class EdgeListener : public hal::FrameListener {
public:
    //   start   pulse tick of virtual time that counts as 0; earlier frames are ignored
    //   levels  of the lines at that time
    //   axes    whose lines are traced, X first
    EdgeListener(std::uint64_t start, PulseLines levels, unsigned axes = kLinearAxes)
        : start_{start}, levels_{levels}, traced_{traced_lines(axes)}
    {
    }

    void frame_played(std::uint64_t start_tick, const PulseFrame& frame) final;

    void frame_begins(std::uint64_t /*tick*/) {}

protected:
    // Pulse tick at the end of the last frame.
    std::uint64_t end() const { return end_; }

private:
    std::uint64_t start_;
    PulseLines levels_;
    unsigned traced_;
    std::uint64_t end_{0};
};

// Lines in the order of their edges: dir_x in bit 0, step_x in bit 1, dir_y in bit 2 and so on. The bit number of a
// line is its wire with the lowest bit inverted.
using LinesInTraceOrder = std::array<std::uint8_t, 1U << 2 * kAxisCount>;
inline constexpr LinesInTraceOrder kLinesInTraceOrder = [] {
    LinesInTraceOrder order{};
    for (unsigned lines = 0; lines < order.size(); ++lines) {
        unsigned ordered = 0;
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            ordered |= ((lines & direction_line(axis)) != 0 ? 1U : 0U) << 2 * axis;
            ordered |= ((lines & step_line(axis)) != 0 ? 2U : 0U) << 2 * axis;
        }
        order[lines] = static_cast<std::uint8_t>(ordered);
    }
    return order;
}();

template <class Own>
void EdgeListener<Own>::frame_played(std::uint64_t start_tick, const PulseFrame& frame)
{
    // A frame in flight at the start does not belong to the trace.
    if (start_tick < start_) {
        return;
    }
    auto& own = static_cast<Own&>(*this);
    const std::uint64_t tick = start_tick - start_;
    own.frame_begins(tick);
    for (const PulseEdge& at : frame.edges) {
        const auto now = static_cast<PulseLines>((levels_ | at.raise) & ~unsigned{at.lower});
        unsigned changed = kLinesInTraceOrder[(now ^ levels_) & traced_];
        const unsigned high = kLinesInTraceOrder[now & traced_];
        levels_ = now;
        for (; changed != 0; changed &= changed - 1) {
            const auto bit = static_cast<unsigned>(__builtin_ctz(changed));
            own.edge(tick + at.tick, bit ^ 1U, (high >> bit & 1U) != 0);
        }
    }
    end_ = tick + kPulseTicksPerFrame;
}

}  // namespace cusp::program_run
