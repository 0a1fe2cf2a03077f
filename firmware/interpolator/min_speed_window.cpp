// Minimum of the speed envelope over a sliding window.
#include "firmware/interpolator/min_speed_window.hpp"

#include <algorithm>

namespace cusp::interpolator {

using planner::Interval;
using planner::PathQueue;

float braking_before_end(const Interval& interval,
                         float distance,
                         const OverrideFactors& factors) noexcept
{
    const planner::Envelope& envelope = interval.envelope;
    const float scaled_off = (1.0F - factors.of(interval.origin_kind)) * envelope.feed_origin;
    return std::min(envelope.end_speed, envelope.feed_end - scaled_off) +
           2.0F * envelope.slope * distance;
}

float cap_of(const Interval& interval, const OverrideFactors& factors) noexcept
{
    const planner::SpeedLimit& limit = interval.envelope.limit;
    return std::min(limit.cap, factors.of(interval.kind) * limit.feed);
}

void MinSpeedWindow::restart(std::uint32_t interval, std::uint64_t end_position) noexcept
{
    begin_ = 0;
    end_ = 0;
    interval_ = interval;
    interval_end_ = end_position;
    started_ = true;
}

void MinSpeedWindow::push(std::uint64_t position, float speed) noexcept
{
    const Entry added{static_cast<std::uint32_t>(position),
                      static_cast<std::uint32_t>(position >> 32U), speed};
    while (end_ != begin_ && entries_[(end_ - 1) % kEntries].speed >= added.speed) {
        --end_;
    }
    if (end_ - begin_ == kEntries) {
        // Full: the newest two become one, as strict as both for as long as both.
        Entry& last = entries_[(end_ - 1) % kEntries];
        last.low = added.low;
        last.high = added.high;
        return;
    }
    entries_[end_ % kEntries] = added;
    ++end_;
}

float MinSpeedWindow::least_between(const PathQueue& queue,
                                    std::uint64_t from,
                                    std::uint64_t to,
                                    const OverrideFactors& factors) noexcept
{
    while (begin_ != end_ && entries_[begin_ % kEntries].position() < from) {
        ++begin_;
    }
    const std::uint32_t published = queue.published();
    if (interval_ == published) {
        return 0;
    }
    for (std::uint32_t i = 0; interval_end_ < to; ++i) {
        const Interval& passed = queue.interval(interval_);
        if (interval_ + 1 == published || passed.stop_at_end || i == kIntervalsPerTick) {
            return 0.0F;
        }
        push(interval_end_,
             std::min(cap_of(passed, factors), braking_before_end(passed, 0.0F, factors)));
        ++interval_;
        interval_end_ += queue.interval(interval_).length;
    }
    const float left = static_cast<float>(static_cast<std::uint32_t>(interval_end_ - to)) /
                       kPathUnitsPerMillimetre;
    const Interval& last = queue.interval(interval_);
    float least = std::min(cap_of(last, factors), braking_before_end(last, left, factors));
    if (begin_ != end_) {
        least = std::min(least, entries_[begin_ % kEntries].speed);
    }
    return least;
}

}  // namespace cusp::interpolator
