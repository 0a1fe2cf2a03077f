// Spreading of speed limits over the travel of the path filter.
#include "firmware/planner/interval_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/assert.hpp"

namespace cusp::planner {
namespace {

constexpr float kTimeUnitsPerSecond = 1e7F;
constexpr float kLongestTime = 100.0F;  // s; longer counts as this
// A split leaves no piece shorter than this, mm, nor than a third of what a tick travels: the servo
// looks at no more than 16 intervals a tick.
constexpr float kShortestPiece = 1e-4F;
constexpr float kShortestTime = kServoTick / 3.0F;
// mm: what is carried so far counts for the whole of a block, which has at most 64. Below it, path units
// fit 32 bits.
constexpr float kWholeBlock = 60.0F;

float shortest_piece(float greatest_speed) noexcept
{
    return std::max(kShortestPiece, greatest_speed * kShortestTime);
}

float millimetres(std::uint32_t path_units) noexcept
{
    return static_cast<float>(path_units) / kPathUnitsPerMillimetre;
}

std::uint32_t path_units(float mm) noexcept
{
    return static_cast<std::uint32_t>(mm * kPathUnitsPerMillimetre);
}

// The limits of a stretch alone, and its feed alone: they are spread over different distances.
Allowance limits_alone(Allowance allowance) noexcept
{
    allowance.feed = kUnlimited;
    return allowance;
}

Allowance acceleration_alone(float acceleration) noexcept
{
    Allowance allowance = kAllowsAll;
    allowance.by_acceleration = {acceleration, acceleration};
    return allowance;
}

Allowance feed_alone(float squared_feed) noexcept
{
    Allowance allowance = kAllowsAll;
    allowance.feed = squared_feed;
    return allowance;
}

}  // namespace

void IntervalBuilder::refresh_time(Interval& interval) noexcept
{
    const float speed = greatest_speed(interval.allowance, interval.kind);
    const float time =
        std::min(millimetres(interval.length) / std::max(speed, 1e-6F), kLongestTime);
    const auto units = static_cast<std::uint32_t>(time * kTimeUnitsPerSecond);
    pending_time_ += units;
    pending_time_ -= interval.least_time;
    interval.least_time = units;
}

void IntervalBuilder::restrict(Interval& interval, const Allowance& allowance) noexcept
{
    restrict_to(interval.allowance, allowance);
    refresh_time(interval);
}

void IntervalBuilder::append_piece(std::uint32_t length,
                                   const Allowance& allowance,
                                   path::MoveKind kind) noexcept
{
    Interval interval{};
    interval.length = length;
    interval.allowance = allowance;
    interval.kind = kind;
    refresh_time(interval);
    queue_.append_interval(interval);
}

void IntervalBuilder::append(std::uint32_t length,
                             const Allowance& allowance,
                             path::MoveKind kind) noexcept
{
    const Allowance limits = limits_alone(allowance);
    const float limits_reach = greatest_speed(allowance, kind) * reach_.limit;
    const float feed_reach = std::sqrt(kGreatestFeedFactor * allowance.feed) * reach_.feed;
    spread_back(limits_reach, limits);
    spread_feed_back(feed_reach, allowance.feed);
    greatest_feed_ = std::max(greatest_feed_, allowance.feed);

    // Cut where a limit carried over from earlier stretches ends.
    std::uint32_t left = length;
    const float shortest = shortest_piece(greatest_speed(allowance, kind));
    while (left > 0) {
        std::uint32_t piece = left;
        Allowance all = allowance;
        for (const Carry& carried : carries_) {
            if (carried.feed_alone) {
                restrict_to_feed(all, carried.allowance.feed);
            } else {
                restrict_to(all, carried.allowance);
            }
            if (carried.distance < kWholeBlock) {
                piece = std::min(piece, path_units(std::max(carried.distance, shortest)));
            }
        }
        if (millimetres(left - piece) < shortest) {
            piece = left;
        }
        append_piece(piece, all, kind);
        left -= piece;
        travel(millimetres(piece));
    }
    carry(limits_reach, limits);
    carry(feed_reach, feed_alone(allowance.feed), true);
}

void IntervalBuilder::add_junction(const JunctionShare& junction, float distance) noexcept
{
    Allowance allowance = kAllowsAll;
    allowance.cap = junction.caps ? junction.speed * junction.speed : kUnlimited;
    const float at_rest = junction.caps ? junction.jerk_at_rest : junction.jerk;
    allowance.jerk_left = {1.0F - at_rest, 1.0F - junction.jerk};
    allowance.acceleration_left = 1.0F - junction.acceleration;
    spread_back(junction.speed * reach_.junction + distance, allowance);
    carry(junction.speed * reach_.junction - distance, allowance);
}

// Restricts the last `reached` mm of an interval, which is split.
void IntervalBuilder::restrict_end(std::uint32_t at,
                                   float reached,
                                   const Allowance& allowance) noexcept
{
    Interval& interval = queue_.interval(at);
    Interval front = interval;
    const std::uint32_t back = std::max(path_units(reached), std::uint32_t{1});
    front.length = interval.length - back;
    front.least_time = 0;
    interval.length = back;
    queue_.insert_interval(at, front);
    refresh_time(queue_.interval(at));
    restrict(queue_.interval(at + 1), allowance);
}

// binds_on(other): whether the allowance binds where `other` does.
template <class Binds>
void IntervalBuilder::spread_back(float distance,
                                  const Allowance& allowance,
                                  Binds binds_on) noexcept
{
    float left = distance;
    std::uint32_t at = queue_.interval_end();
    const std::uint32_t published = queue_.published();
    while (left > 0 && at != published) {
        Interval& interval = queue_.interval(at - 1);
        const float length = millimetres(interval.length);
        if (binds_on(interval.allowance)) {
            const float shortest =
                shortest_piece(greatest_speed(interval.allowance, interval.kind));
            const float reached = std::max(left, shortest);
            if (length - reached > shortest && queue_.free_intervals() > kMostPerAppend) {
                restrict_end(at - 1, reached, allowance);
                return;
            }
            restrict(interval, allowance);
        }
        left -= length;
        --at;
    }
}

void IntervalBuilder::spread_back(float distance, const Allowance& allowance) noexcept
{
    spread_back(distance, allowance,
                [&allowance](const Allowance& other) { return binds(allowance, other); });
}

// A feed reaches far over intervals of, mostly, the same feed, and nothing else of it binds.
void IntervalBuilder::spread_feed_back(float distance, float squared_feed) noexcept
{
    if (squared_feed >= greatest_feed_) {
        return;
    }
    spread_back(distance, feed_alone(squared_feed),
                [squared_feed](const Allowance& other) { return squared_feed < other.feed; });
}

template <class Keep>
void IntervalBuilder::keep_carries(Keep keep) noexcept
{
    std::size_t kept = 0;
    for (std::size_t i = 0; i < carries_.size(); ++i) {
        if (!keep(carries_[i])) {
            continue;
        }
        if (kept != i) {
            carries_[kept] = carries_[i];
        }
        ++kept;
    }
    carries_.shrink(kept);
}

// Drops the carried limits that end within `distance`.
void IntervalBuilder::travel(float distance) noexcept
{
    for (Carry& carried : carries_) {
        carried.distance -= distance;
    }
    keep_carries([](const Carry& carried) { return carried.distance > kShortestPiece; });
}

void IntervalBuilder::carry(float distance, const Allowance& allowance, bool feed_alone) noexcept
{
    if (distance <= kShortestPiece) {
        return;
    }
    // One that is nowhere stricter and ends no later is not needed.
    keep_carries([&](const Carry& carried) {
        return carried.distance > distance || binds(carried.allowance, allowance);
    });
    if (carries_.full()) {
        merge_closest_carries();
    }
    // In rising order of distance.
    (void)carries_.try_push_back({distance, allowance, feed_alone});
    for (std::size_t i = carries_.size() - 1; i > 0 && carries_[i - 1].distance > distance; --i) {
        std::swap(carries_[i - 1], carries_[i]);
    }
}

// The two that end closest together, by ratio, become one that is as strict as both and lasts as
// long as the longer.
void IntervalBuilder::merge_closest_carries() noexcept
{
    std::size_t closest = 0;
    float least = kUnlimited;
    for (std::size_t i = 0; i + 1 < carries_.size(); ++i) {
        const float ratio = carries_[i + 1].distance / carries_[i].distance;
        if (ratio < least) {
            least = ratio;
            closest = i;
        }
    }
    Carry& longer = carries_[closest + 1];
    restrict_to(longer.allowance, carries_[closest].allowance);
    longer.feed_alone = longer.feed_alone && carries_[closest].feed_alone;
    for (std::size_t i = closest; i + 1 < carries_.size(); ++i) {
        carries_[i] = carries_[i + 1];
    }
    carries_.pop_back();
}

void IntervalBuilder::stop(const CornerOverlap& overlap) noexcept
{
    carries_.clear();
    greatest_feed_ = 0;
    if (queue_.interval_end() == queue_.published()) {
        return;
    }
    if (overlap.ticks > 0) {
        spread_back(overlap.before, acceleration_alone(overlap.braking));
        carry(overlap.after, acceleration_alone(overlap.speeding));
    }
    Interval& last = queue_.interval(queue_.interval_end() - 1);
    last.stop_at_end = true;
    last.overlap = overlap.ticks;
    queue_.block(queue_.block_end() - 1).stops = true;
    publish_to(queue_.interval_end());
}

void IntervalBuilder::publish(bool queue_full) noexcept
{
    const auto hold_back =
        static_cast<std::uint64_t>((reach_.junction + reach_.feed) * kTimeUnitsPerSecond);
    if (queue_full && queue_.published() == queue_.interval_begin() &&
        pending_time_ < 2 * hold_back) {
        // The whole queue is shorter than the reach: pass it more slowly.
        const float factor = 0.25F;
        for (std::uint32_t i = queue_.published(); i != queue_.interval_end(); ++i) {
            Interval& interval = queue_.interval(i);
            interval.allowance.cap *= factor;
            interval.allowance.feed *= factor;
            refresh_time(interval);
        }
    }
    std::uint32_t end = queue_.published();
    std::uint64_t pending = pending_time_;
    while (end != queue_.interval_end() && pending >= hold_back + queue_.interval(end).least_time) {
        pending -= queue_.interval(end).least_time;
        ++end;
    }
    publish_to(end);
}

void IntervalBuilder::publish_to(std::uint32_t end) noexcept
{
    for (std::uint32_t i = queue_.published(); i != end; ++i) {
        Interval& interval = queue_.interval(i);
        interval.envelope = {speed_limit(interval.allowance, queue_.half_filter()), 0, 0, 0, 0};
        pending_time_ -= interval.least_time;
        queue_.add_published_length(interval.length);
    }
    queue_.publish(end);
}

void IntervalBuilder::clear() noexcept
{
    carries_.clear();
    greatest_feed_ = 0;
    pending_time_ = 0;
}

}  // namespace cusp::planner
