// The backward pass over the published intervals.
#include "firmware/planner/look_ahead.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace cusp::planner {
namespace {

// Braking acceleration over an interval that ends at the squared speed `end`.
float braking(const SpeedLimit& limit, float end, float length, float half_filter) noexcept
{
    if (limit.at_rest == limit.least) {
        return limit.least;
    }
    // The acceleration at no less than the highest speed of the interval, which is the least.
    const float most = limit.acceleration_at(std::sqrt(end), half_filter);
    const float fastest = std::min(end + 2.0F * length * most, limit.cap);
    return limit.acceleration_at(std::sqrt(fastest), half_filter);
}

// The limits at an interval's end set by the path after it.
struct Ahead {
    float speed;
    float feed;
    float feed_origin;
    bool origin_is_rapid;
};

Ahead start_of(const Interval& interval) noexcept
{
    const Envelope& envelope = interval.envelope;
    const float length = static_cast<float>(interval.length) / kPathUnitsPerMillimetre;
    const float speed = envelope.end_speed + 2.0F * envelope.slope * length;
    const float feed = envelope.feed_end + 2.0F * envelope.slope * length;
    const bool own = envelope.limit.feed <= feed;
    return {std::min(envelope.limit.cap, speed), own ? envelope.limit.feed : feed,
            own ? envelope.limit.feed : envelope.feed_origin,
            own ? interval.rapid : interval.origin_is_rapid};
}

// False where nothing changed.
bool update(Interval& interval, const Ahead& ahead, float half_filter) noexcept
{
    Envelope& envelope = interval.envelope;
    const bool stops = interval.stop_at_end;
    const float end = stops ? 0.0F : std::min(envelope.limit.cap, ahead.speed);
    const float feed = stops ? envelope.limit.feed : ahead.feed;
    const bool feed_is_own = stops || envelope.limit.feed <= feed;
    const float feed_end = feed_is_own ? envelope.limit.feed : feed;
    if (end == envelope.end_speed && feed_end == envelope.feed_end && envelope.slope > 0) {
        return false;
    }
    const float length = static_cast<float>(interval.length) / kPathUnitsPerMillimetre;
    // A higher end may mean less braking over the interval: that first, or the tick could see the
    // higher end with the stronger brake.
    envelope.slope = braking(envelope.limit, end, length, half_filter);
    envelope.feed_origin = feed_is_own ? envelope.limit.feed : ahead.feed_origin;
    interval.origin_is_rapid = feed_is_own ? interval.rapid : ahead.origin_is_rapid;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    envelope.end_speed = end;
    envelope.feed_end = feed_end;
    return true;
}

}  // namespace

void look_ahead(PathQueue& queue) noexcept
{
    Ahead ahead{0.0F, kUnlimited, kUnlimited, false};
    const std::uint32_t begin = queue.interval_begin();
    for (std::uint32_t i = queue.published(); i != begin; --i) {
        Interval& interval = queue.interval(i - 1);
        if (!update(interval, ahead, queue.half_filter())) {
            return;
        }
        queue.note_change(i - 1);
        ahead = start_of(interval);
    }
}

}  // namespace cusp::planner
