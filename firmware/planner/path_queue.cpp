// The rings of the path ahead.
#include "firmware/planner/path_queue.hpp"

#include "firmware/base/assert.hpp"

namespace cusp::planner {

void PathQueue::append_block() noexcept
{
    CUSP_ASSERT(free_blocks() > 0);
    store(block_end_, block_end() + 1);
}

void PathQueue::clear() noexcept
{
    store(block_begin_, 0);
    store(block_end_, 0);
    store(curve_begin_, 0);
    curve_end_ = 0;
    plans_.clear();
}

}  // namespace cusp::planner
