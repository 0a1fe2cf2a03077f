// SampleBlocks: the set points of a run in 1 to 2 bytes a tick, exact.
//
// Third differences of whole nanometres are small: jerk and rounding. Each block of ticks starts with position,
// velocity and acceleration, followed by the third differences by axes and byte planes, deflated. Stretches that repeat
// earlier ones, such as layers of roughing, are replaced by references.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/base/axis.hpp"
#include "firmware/base/vec.hpp"
#include "host_tools/judge/view/byte_text.hpp"
#include "host_tools/judge/view/repetition_search.hpp"

namespace cusp::view {

class SampleBlocks {
public:
    static constexpr std::size_t kBlock = 65536;

    // The set point of the next tick, nm.
    void add(Position at);

    std::uint64_t ticks() const { return ticks_; }

    // Ends the last block. Format: u32 ticks, u32 ticks of a block; then blocks: for each axis f64
    // position, first and second difference of the first tick and u8 number of planes; then u32 size and,
    // deflated, the ticks after the first: varint number of repetitions, for each one varints
    // ticks since the previous one (or the block's first), its ticks, and the distance in ticks to the original; then
    // the planes of the ticks that are no repetition. Third differences of earlier blocks are those of the
    // positions; before the first tick nothing moves.
    Bytes finish();

private:
    void leave_out_repetitions(Bytes& out);
    void end_block();

    std::uint64_t ticks_{0};
    std::array<Position, 3> last_{};   // position and its differences, newest
    std::array<Position, 3> first_{};  // of the block
    std::array<std::vector<std::uint64_t>, kLinearAxes>
        third_;  // of the block's ticks after the first
    RepetitionSearch repeated_;
    Bytes blocks_;
};

}  // namespace cusp::view
