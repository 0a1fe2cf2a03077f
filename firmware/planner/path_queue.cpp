// The two rings of the path ahead.
#include "firmware/planner/path_queue.hpp"

#include "firmware/base/assert.hpp"

namespace cusp::planner {

void PathQueue::append_block() noexcept
{
    CUSP_ASSERT(free_blocks() > 0);
    store(block_end_, block_end() + 1);
}

void PathQueue::append_interval(const Interval& added) noexcept
{
    CUSP_ASSERT(free_intervals() > 0);
    interval(interval_end_) = added;
    ++interval_end_;
}

void PathQueue::insert_interval(std::uint32_t before, const Interval& added) noexcept
{
    CUSP_ASSERT(free_intervals() > 0);
    for (std::uint32_t i = interval_end_; i != before; --i) {
        interval(i) = interval(i - 1);
    }
    interval(before) = added;
    ++interval_end_;
}

void PathQueue::clear() noexcept
{
    store(block_begin_, 0);
    store(block_end_, 0);
    store(curve_begin_, 0);
    curve_end_ = 0;
    store(interval_begin_, 0);
    store(published_, 0);
    store(changed_from_, 0);
    interval_end_ = 0;
    published_length_ = 0;
}

}  // namespace cusp::planner
