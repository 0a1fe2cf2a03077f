// SampleBlocks: the set points of a run in 1 to 2 bytes a tick, exact.
//
// Third differences of whole nanometres are small: the jerk and the rounding. Each block of ticks
// begins with position, velocity and acceleration, then has the third differences axis by axis, byte plane by byte plane,
// deflated.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/base/axis.hpp"
#include "firmware/base/vec.hpp"
#include "host_tools/view/byte_text.hpp"

namespace cusp::view {

class SampleBlocks {
public:
    static constexpr std::size_t kBlock = 65536;

    // The set point of the next tick, nm.
    void add(Position at);

    std::uint64_t ticks() const { return ticks_; }

    // Ends the last block. The bytes: u32 ticks, u32 ticks of a block; then blocks: for each axis f64
    // position, first and second difference of the first tick and u8 number of planes; u32 size and
    // the deflated planes of the ticks after the first.
    Bytes finish();

private:
    void end_block();

    std::uint64_t ticks_{0};
    std::array<Position, 3> last_{};   // position and its differences, newest
    std::array<Position, 3> first_{};  // of the block
    PerAxis<std::vector<std::uint64_t>> third_;
    Bytes blocks_;
};

}  // namespace cusp::view
