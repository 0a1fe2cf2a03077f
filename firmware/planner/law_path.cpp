// Places of a stretch are found from where the last one was.
#include "firmware/planner/law_path.hpp"

#include <algorithm>

#include "firmware/base/assert.hpp"

namespace cusp::planner {

void LawPath::append(const Block& block) noexcept
{
    CUSP_ASSERT(!full() && !closed_);
    blocks_[end_ % kRing] = &block;
    ++end_;
    length_ += block.length;
}

void LawPath::seek(PathCursor& cursor, std::int64_t at, bool left) const noexcept
{
    const auto lies_before = [at, left](std::int64_t joint) {
        return left ? at <= joint : at < joint;
    };
    while (cursor.block != begin_.block && lies_before(cursor.begin)) {
        --cursor.block;
        cursor.begin -= (*this)[cursor.block].block->length;
    }
    while (cursor.block + 1 != end_) {
        const std::int64_t end = cursor.begin + (*this)[cursor.block].block->length;
        if (lies_before(end)) {
            break;
        }
        cursor.begin = end;
        ++cursor.block;
    }
}

LaneDerivatives LawPath::derivatives(const PathCursor& cursor, std::int64_t at) const noexcept
{
    const Block& block = *(*this)[cursor.block].block;
    const std::int64_t offset = std::clamp<std::int64_t>(at - cursor.begin, 0, block.length);
    return derivatives_at(block, to_mm(offset));
}

}  // namespace cusp::planner
