// Spreading of speed limits over the travel of the path filter.
#include "firmware/planner/interval_builder.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"

namespace cusp::planner {
namespace {

constexpr float kTimeUnitsPerSecond = 1e7F;
constexpr float kLongestTime = 100.0F;  // s; longer counts as this
// The feed override goes up to 200 %: squared, four times.
constexpr float kGreatestFeedFactor = 4.0F;
// A split leaves no piece shorter than this.
constexpr float kShortestPiece = 1e-4F;  // mm

float millimetres(std::uint32_t path_units) noexcept
{
    return static_cast<float>(path_units) / kPathUnitsPerMillimetre;
}

std::uint32_t path_units(float mm) noexcept
{
    return static_cast<std::uint32_t>(mm * kPathUnitsPerMillimetre);
}

float greatest_speed(const SpeedLimit& limit, bool rapid) noexcept
{
    const float feed = rapid ? limit.feed : kGreatestFeedFactor * limit.feed;
    return std::sqrt(std::min(limit.cap, feed));
}

}  // namespace

void IntervalBuilder::refresh_time(Interval& interval) noexcept
{
    const float speed = greatest_speed(interval.limit, interval.rapid);
    const float time =
        std::min(millimetres(interval.length) / std::max(speed, 1e-6F), kLongestTime);
    const auto units = static_cast<std::uint32_t>(time * kTimeUnitsPerSecond);
    pending_time_ += units;
    pending_time_ -= interval.least_time;
    interval.least_time = units;
}

void IntervalBuilder::restrict(Interval& interval, const Restriction& restriction) noexcept
{
    interval.limit = stricter(interval.limit, restriction.limit);
    interval.scale0 = std::min(interval.scale0, restriction.scale0);
    interval.scale1 = std::min(interval.scale1, restriction.scale1);
    refresh_time(interval);
}

void IntervalBuilder::append_piece(std::uint32_t length,
                                   const SpeedLimit& limit,
                                   bool rapid) noexcept
{
    Interval interval{};
    interval.length = length;
    interval.limit = limit;
    interval.scale0 = 1;
    interval.scale1 = 1;
    interval.rapid = rapid;
    refresh_time(interval);
    queue_.append_interval(interval);
}

void IntervalBuilder::append(std::uint32_t length, const SpeedLimit& limit, bool rapid) noexcept
{
    const float speed = greatest_speed(limit, rapid);
    spread_back(speed * reach_.limit, {{limit.cap, limit.u0, limit.u1, kUnlimited}, 1, 1});
    const float feed = std::sqrt(kGreatestFeedFactor * limit.feed);
    spread_back(feed * reach_.feed, {{kUnlimited, kUnlimited, kUnlimited, limit.feed}, 1, 1});

    // Cut where a limit carried over from earlier stretches ends.
    std::uint32_t left = length;
    while (left > 0) {
        std::uint32_t piece = left;
        Restriction over{};
        for (const Carry& carried : carries_) {
            over.limit = stricter(over.limit, carried.restriction.limit);
            over.scale0 = std::min(over.scale0, carried.restriction.scale0);
            over.scale1 = std::min(over.scale1, carried.restriction.scale1);
            const std::uint32_t reach = path_units(std::max(carried.distance, kShortestPiece));
            piece = std::min(piece, carried.distance < 60.0F ? reach : piece);
        }
        if (millimetres(left - piece) < kShortestPiece) {
            piece = left;
        }
        append_piece(piece, limit, rapid);
        restrict(queue_.interval(queue_.interval_end() - 1), over);
        left -= piece;
        const float passed = millimetres(piece);
        StaticVector<Carry, kCarries> still;
        for (Carry carried : carries_) {
            carried.distance -= passed;
            if (carried.distance > kShortestPiece) {
                (void)still.try_push_back(carried);
            }
        }
        carries_ = still;
    }
    carry(speed * reach_.limit, {{limit.cap, limit.u0, limit.u1, kUnlimited}, 1, 1});
    carry(feed * reach_.feed, {{kUnlimited, kUnlimited, kUnlimited, limit.feed}, 1, 1});
}

void IntervalBuilder::add_joint(const Restriction& restriction, float speed) noexcept
{
    spread_back(speed * reach_.joint, restriction);
    carry(speed * reach_.joint, restriction);
}

void IntervalBuilder::spread_back(float distance, const Restriction& restriction) noexcept
{
    float left = distance;
    std::uint32_t at = queue_.interval_end();
    while (left > 0 && at != queue_.published()) {
        Interval& interval = queue_.interval(at - 1);
        const float length = millimetres(interval.length);
        const SpeedLimit& limit = restriction.limit;
        const bool binds = restriction.scale0 < interval.scale0 ||
                           restriction.scale1 < interval.scale1 || limit.cap < interval.limit.cap ||
                           limit.u0 < interval.limit.u0 || limit.u1 < interval.limit.u1 ||
                           limit.feed < interval.limit.feed;
        const bool split =
            binds && length - left > kShortestPiece && queue_.free_intervals() > kMostPerAppend;
        if (split) {
            // Only the end of this interval is in reach.
            Interval front = interval;
            const std::uint32_t back = std::max(path_units(left), std::uint32_t{1});
            front.length = interval.length - back;
            front.least_time = 0;
            interval.length = back;
            queue_.insert_interval(at - 1, front);
            refresh_time(queue_.interval(at - 1));
            restrict(queue_.interval(at), restriction);
            return;
        }
        if (binds) {
            restrict(interval, restriction);
        }
        left -= length;
        --at;
    }
}

void IntervalBuilder::carry(float distance, const Restriction& restriction) noexcept
{
    if (distance <= kShortestPiece) {
        return;
    }
    if (carries_.full()) {
        // Two become one that is as strict as both and lasts as long as the longer.
        Carry& last = carries_.back();
        last.distance = std::max(last.distance, distance);
        last.restriction.limit = stricter(last.restriction.limit, restriction.limit);
        last.restriction.scale0 = std::min(last.restriction.scale0, restriction.scale0);
        last.restriction.scale1 = std::min(last.restriction.scale1, restriction.scale1);
        return;
    }
    // One that is nowhere stricter and ends no later is not needed.
    StaticVector<Carry, kCarries> still;
    const SpeedLimit& added = restriction.limit;
    for (const Carry& carried : carries_) {
        const SpeedLimit& old = carried.restriction.limit;
        const bool scales = carried.restriction.scale0 < restriction.scale0 ||
                            carried.restriction.scale1 < restriction.scale1;
        const bool needless = !scales && carried.distance <= distance && added.cap <= old.cap &&
                              added.u0 <= old.u0 && added.u1 <= old.u1 && added.feed <= old.feed;
        if (!needless) {
            (void)still.try_push_back(carried);
        }
    }
    carries_ = still;
    (void)carries_.try_push_back({distance, restriction});
}

void IntervalBuilder::stop() noexcept
{
    carries_.clear();
    if (queue_.interval_end() == queue_.published()) {
        return;
    }
    queue_.interval(queue_.interval_end() - 1).stop_at_end = true;
    publish_to(queue_.interval_end());
}

void IntervalBuilder::publish(bool queue_full) noexcept
{
    const auto hold_back =
        static_cast<std::uint64_t>((reach_.joint + reach_.feed) * kTimeUnitsPerSecond);
    if (queue_full && queue_.published() == queue_.interval_begin() &&
        pending_time_ < 2 * hold_back) {
        // The whole queue is shorter than the reach: pass it more slowly.
        const float factor = 0.25F;
        for (std::uint32_t i = queue_.published(); i != queue_.interval_end(); ++i) {
            Interval& interval = queue_.interval(i);
            interval.limit.cap *= factor;
            interval.limit.feed *= factor;
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
        interval.limit.u0 *= interval.scale0;
        interval.limit.u1 *= interval.scale1;
        pending_time_ -= interval.least_time;
        queue_.add_published_length(interval.length);
    }
    queue_.publish(end);
}

void IntervalBuilder::clear() noexcept
{
    carries_.clear();
    pending_time_ = 0;
}

}  // namespace cusp::planner
