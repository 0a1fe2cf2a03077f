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
    const float least_from = limit.least_from(half_filter);
    const float slowest = std::sqrt(end);
    if (slowest >= least_from) {
        return limit.least;
    }
    const float most = limit.acceleration_below(slowest, least_from);
    const float fastest = std::min(end + 2.0F * length * most, limit.cap);
    return limit.acceleration_below(std::sqrt(fastest), least_from);
}

// The limits at an interval's end set by the path after it.
struct Ahead {
    float speed;
    float feed;
    float feed_origin;
    path::MoveKind feed_kind;
};

// Takes the limits at the interval's end to those at its start. False where nothing changed.
bool update(Interval& interval, Ahead& ahead, float half_filter) noexcept
{
    Envelope& envelope = interval.envelope;
    const float cap = envelope.limit.cap;
    const float own_feed = envelope.limit.feed;
    const bool stops = interval.stop_at_end;
    const float end = stops ? 0.0F : std::min(cap, ahead.speed);
    if (stops || own_feed <= ahead.feed) {
        ahead = {0.0F, own_feed, own_feed, interval.kind};
    }
    if (end == envelope.end_speed && ahead.feed == envelope.feed_end && envelope.slope > 0) {
        return false;
    }
    const float length = static_cast<float>(interval.length) / kPathUnitsPerMillimetre;
    // A higher end may mean less braking over the interval: that first, or the tick could see the
    // higher end with the stronger brake.
    const float slope = braking(envelope.limit, end, length, half_filter);
    envelope.slope = slope;
    envelope.feed_origin = ahead.feed_origin;
    interval.origin_kind = ahead.feed_kind;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    envelope.end_speed = end;
    envelope.feed_end = ahead.feed;

    const float gained = 2.0F * slope * length;
    ahead.speed = std::min(cap, end + gained);
    ahead.feed += gained;
    if (own_feed <= ahead.feed) {
        ahead = {ahead.speed, own_feed, own_feed, interval.kind};
    }
    return true;
}

}  // namespace

void look_ahead(PathQueue& queue) noexcept
{
    Ahead ahead{0.0F, kUnlimited, kUnlimited, path::MoveKind::kFeed};
    const std::uint32_t begin = queue.interval_begin();
    const float half_filter = queue.half_filter();
    for (std::uint32_t i = queue.published(); i != begin; --i) {
        if (!update(queue.interval(i - 1), ahead, half_filter)) {
            return;
        }
        queue.note_change(i - 1);
    }
}

}  // namespace cusp::planner
