// Computes differences for each tick, planes and deflate at the end of a block.
#include "host_tools/judge/view/sample_blocks.hpp"

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
    const std::array<std::uint64_t, kLinearAxes> third{zigzag(jerk[0]), zigzag(jerk[1]),
                                                       zigzag(jerk[2])};
    if (ticks_ % kBlock == 0) {
        if (ticks_ > 0) {
            end_block();
        }
        first_ = last_;
    } else {
        for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
            third_[axis].push_back(third[axis]);
        }
    }
    repeated_.add(third);
    ++ticks_;
}

// Removes repetitions from third_ and writes references to them.
void SampleBlocks::leave_out_repetitions(Bytes& out)
{
    const std::size_t begin = ticks_ - third_[0].size();
    const std::vector<Repetition> repetitions = repeated_.find(begin, ticks_);
    out.put_varint(repetitions.size());
    std::size_t last = begin;
    for (const Repetition& repetition : repetitions) {
        out.put_varint(repetition.first - last);
        out.put_varint(repetition.count);
        out.put_varint(repetition.distance);
        last = repetition.first + repetition.count;
    }
    for (std::vector<std::uint64_t>& values : third_) {
        std::size_t kept = 0;
        std::size_t from = begin;
        const auto keep = [&](std::size_t to) {
            for (; from < to; ++from) {
                values[kept++] = values[from - begin];
            }
        };
        for (const Repetition& repetition : repetitions) {
            keep(repetition.first);
            from += repetition.count;
        }
        keep(ticks_);
        values.resize(kept);
    }
}

void SampleBlocks::end_block()
{
    Bytes planes;
    leave_out_repetitions(planes);
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
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
