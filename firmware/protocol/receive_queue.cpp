// A ring of bytes that counts what it loses.
#include "firmware/protocol/receive_queue.hpp"

namespace cusp::protocol {

void ReceiveQueue::put(std::uint8_t byte) noexcept
{
    if (!losing_ && ring_.try_push(byte)) {
        ++received_;
        return;
    }
    losing_ = true;
    last_lost_ended_line_ = is_line_end(byte);
    if (last_lost_ended_line_) {
        ++lost_line_ends_;
    }
}

std::uint32_t ReceiveQueue::take_lost_line_ends() noexcept
{
    const std::uint32_t lost = lost_line_ends_;
    lost_line_ends_ = 0;
    losing_ = false;
    return lost;
}

void ReceiveQueue::clear() noexcept
{
    ring_.clear();
    losing_ = false;
    lost_line_ends_ = 0;
}

}  // namespace cusp::protocol
