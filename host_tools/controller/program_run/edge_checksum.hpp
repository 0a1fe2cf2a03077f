// EdgeChecksum: one number for all edges of a run, to compare the pulses of two machines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/base/axis.hpp"
#include "hal/sim/simulated_player.hpp"
#include "host_tools/controller/program_run/edge_listener.hpp"

namespace cusp::program_run {

// CRC-32 (IEEE 802.3) of all edges in the order of the pulse trace (edge_listener.hpp). An edge is 10 bytes: its
// pulse tick in us as 8 bytes, little endian, its wire, and its level, 0 or 1.
class EdgeChecksum : public hal::FrameListener {
public:
    //   start   pulse tick of virtual time that counts as 0; earlier frames are ignored
    //   levels  of the lines at that time
    //   axes    whose lines are traced, X first
    EdgeChecksum(std::uint64_t start, PulseLines levels, unsigned axes = kLinearAxes)
        : start_{start}, levels_{levels}, traced_{traced_lines(axes)}
    {
    }

    void frame_played(std::uint64_t start_tick, const PulseFrame& frame) final;

    std::uint32_t value() const { return ~remainder_; }

    // Lines as the edges of one pulse tick are ordered.
    static constexpr std::array<PulseLines, 2 * kAxisCount> kLinesInOrder = [] {
        std::array<PulseLines, 2 * kAxisCount> lines{};
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            lines[2 * axis] = direction_line(axis);
            lines[2 * axis + 1] = step_line(axis);
        }
        return lines;
    }();

private:
    void fold(std::size_t count, std::uint32_t end);

    std::uint64_t start_;
    PulseLines levels_;
    unsigned traced_;
    std::uint32_t remainder_{0xFFFFFFFFU};
    // Adds a frame: the tick of each edge, with what the edge before it leaves.
    std::array<std::uint32_t, kLinesInOrder.size() * kPulseTicksPerFrame> digits_{};
};

}  // namespace cusp::program_run
