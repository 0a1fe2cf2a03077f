// Differences on the way in; planes and deflate at the end of a block.
#include "host_tools/view/sample_blocks.hpp"

#include <algorithm>

namespace cusp::view {

void SampleBlocks::add(Position at)
{
    if (ticks_ == 0) {
        last_ = {at, Position{}, Position{}};
    }
    const Position velocity = at - last_[0];
    const Position acceleration = velocity - last_[1];
    const Position jerk = acceleration - last_[2];
    last_ = {at, velocity, acceleration};
    if (ticks_ % kBlock == 0) {
        if (ticks_ > 0) {
            end_block();
        }
        first_ = last_;
    } else {
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            third_[axis].push_back(zigzag(jerk[axis]));
        }
    }
    ++ticks_;
}

void SampleBlocks::end_block()
{
    Bytes planes;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        std::uint64_t all = 0;
        for (const std::uint64_t value : third_[axis]) {
            all |= value;
        }
        unsigned count = 0;
        for (; all >> 8U * count != 0; ++count) {
            for (const std::uint64_t value : third_[axis]) {
                planes.put_u8(value >> 8U * count);
            }
            if (count == 7) {
                ++count;
                break;
            }
        }
        for (const Position& difference : first_) {
            blocks_.put_f64(static_cast<double>(difference[axis]));
        }
        blocks_.put_u8(count);
        third_[axis].clear();
    }
    const std::string packed = deflated(planes.text());
    blocks_.put_u32(packed.size());
    blocks_.put(packed);
}

Bytes SampleBlocks::finish()
{
    if (ticks_ > 0) {
        end_block();
    }
    Bytes out;
    out.put_u32(ticks_);
    out.put_u32(kBlock);
    out.put(blocks_.text());
    return out;
}

}  // namespace cusp::view
