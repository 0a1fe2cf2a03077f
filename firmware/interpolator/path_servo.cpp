// The speed along the path, one tick at a time.
#include "firmware/interpolator/path_servo.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::interpolator {
namespace {

using planner::Interval;
using planner::kUnlimited;

// Intervals that one tick may pass at most.
constexpr std::uint32_t kIntervalsPerTick = 16;
// Nearer to a stop than this the tool is there: a quarter of a nanometre.
constexpr std::uint32_t kArrived = 4;

float millimetres(std::uint32_t path_units) noexcept
{
    return static_cast<float>(path_units) / kPathUnitsPerMillimetre;
}

// The root of a squared speed, or `speed` where that is lower.
float lower_root(float square, float speed) noexcept
{
    return square < speed * speed ? std::sqrt(square) : speed;
}

// Greatest speed v, held for one tick and at most `greatest`, that is still under an envelope which
// falls by 2 slope a mm and is `end` after `distance` mm (squared speeds) in the middle of the
// tick's travel: v^2 <= end + 2 slope (distance - v tick/2), or past the end v^2 <= end. Braking by
// slope from tick to tick follows it exactly: the travel from middle to middle is (v + v')/2 tick.
//
// The last tick before a stop may brake no harder. So the slowest speeds are those from which n
// ticks that slow down by `slope` each end where the envelope does, after D mm, were it to fall on:
// D/(n tick) + slope tick (n - 1)/2, with the least n that can do it.
[[gnu::noinline]] float speed_under_envelope(float end,
                                             float slope,
                                             float distance,
                                             float greatest) noexcept
{
    constexpr float kManyTicks = 40.0F;  // the difference is 1/(8 n) of a tick's braking
    const float half = 0.5F * slope * kServoTick;
    const float square = half * half + std::max(end + 2.0F * slope * distance, 0.0F);
    // Those are surely above `greatest` then, too: they differ by an eighth of 2 half at most.
    const float most = greatest + 1.25F * half;
    if (square >= most * most) {
        return greatest;
    }
    float under = std::sqrt(square) - half;
    const float drop = 2.0F * half;
    if (under < kManyTicks * drop) {
        const float whole = 1.0F + static_cast<float>(static_cast<std::uint32_t>(under / drop));
        const float to_stop = std::max(distance + 0.5F * end / slope, 0.0F);
        under = std::min(under, to_stop / (whole * kServoTick) + half * (whole - 1.0F));
    }
    under = std::min(under, greatest);
    const bool past_end = 0.5F * under * kServoTick > distance;
    return past_end ? std::max(under, std::sqrt(std::max(end, 0.0F))) : under;
}

// The same, with what most ticks need of it in line: that `greatest` is surely under the envelope.
inline float speed_under(float end, float slope, float distance, float greatest) noexcept
{
    const float half = 0.5F * slope * kServoTick;
    const float most = greatest + 1.25F * half;
    // Not cut to 0 where it is negative: the test only fails then.
    const float square = half * half + (end + 2.0F * slope * distance);
    return square >= most * most ? greatest : speed_under_envelope(end, slope, distance, greatest);
}

}  // namespace

void PathServo::reset(std::uint32_t filter) noexcept
{
    filter_ = filter;
    speed_window_ = MinSpeedWindow{};
    offset_ = 0;
    position_ = 0;
    travelled_.store(0, std::memory_order_relaxed);
    speed_ = 0;
    residue_ = 0;
    oldest_step_ = 0;
    passed_stop_ = false;
}

std::int32_t PathServo::tick(const Conditions& conditions) noexcept
{
    passed_stop_ = false;
    // The ends of the queue are read once: the main loop does not run meanwhile.
    Ahead ahead{queue_.interval_begin(), queue_.published(), nullptr};
    float speed = 0;
    std::int32_t step = 0;
    if (ahead.begin != ahead.published) {
        ahead.first = &queue_.interval(ahead.begin);
        const bool inside = offset_ < ahead.first->length;
        if (inside || pass_intervals(ahead, conditions.may_pass)) {
            speed = next_speed(ahead, conditions);
            step = speed > 0 ? advance(ahead, speed) : 0;
        }
    }
    if (speed <= 0) {
        residue_ = 0;
    }
    speed_ = speed;
    oldest_step_ = passed_stop_ ? 0 : conditions.oldest_step;
    return step;
}

// Leaves intervals that are passed. False where no path is ahead, or the filters must drain first.
inline bool PathServo::pass_intervals(Ahead& ahead, bool may_pass) noexcept
{
    const planner::Interval* here = ahead.first;
    for (;;) {
        if (here->stop_at_end && !may_pass) {
            return false;
        }
        if (!here->stop_at_end && ahead.begin + 1 == ahead.published) {
            return false;
        }
        if (here->stop_at_end) {
            passed_stop_ = true;
        }
        offset_ -= here->length;
        queue_.drop_interval();
        ++ahead.begin;
        if (ahead.begin == ahead.published) {
            return false;
        }
        here = &queue_.interval(ahead.begin);
        if (offset_ < here->length) {
            ahead.first = here;
            return true;
        }
    }
}

[[gnu::always_inline]] inline PathServo::Bounds PathServo::bounds(
    const Ahead& ahead, float greatest, const OverrideFactors& factors) const noexcept
{
    Bounds least{greatest, greatest, ahead.begin};
    const Interval* interval = ahead.first;
    std::uint32_t index = ahead.begin;
    float to_end = millimetres(interval->length - offset_);
    for (std::uint32_t i = 0;; ++i) {
        const planner::Envelope& envelope = interval->envelope;
        const float slope = envelope.slope;
        least.speed = lower_root(envelope.limit.cap, least.speed);
        least.speed = speed_under(envelope.end_speed, slope, to_end, least.speed);
        const float scaled_off = (1.0F - factors.of(interval->origin_kind)) * envelope.feed_origin;
        least.feed = lower_root(factors.of(interval->kind) * envelope.limit.feed, least.feed);
        least.feed = speed_under(envelope.feed_end - scaled_off, slope, to_end, least.feed);
        least.last = index;
        ++index;
        const bool last = interval->stop_at_end || index == ahead.published;
        if (last || 0.5F * least.speed * kServoTick <= to_end) {
            return least;
        }
        if (i == kIntervalsPerTick) {
            least.speed = to_end / kServoTick;
            return least;
        }
        interval = &queue_.interval(index);
        to_end += millimetres(interval->length);
    }
}

// The least that these intervals allow, mm/s^2.
[[gnu::noinline]] float PathServo::acceleration(std::uint32_t first,
                                                std::uint32_t last) const noexcept
{
    float least = kUnlimited;
    for (std::uint32_t i = first; i != last + 1; ++i) {
        const planner::SpeedLimit& limit = queue_.interval(i).envelope.limit;
        least = std::min(least, limit.acceleration_at(speed_, queue_.half_filter()));
    }
    return least;
}

[[gnu::always_inline]] inline float PathServo::next_speed(const Ahead& ahead,
                                                          const Conditions& conditions) noexcept
{
    const OverrideFactors& factors = conditions.factors;
    const float present = speed_;
    // Between acceleration and braking, one path filter long, neither: so that the filtered
    // acceleration, a difference over one filter, changes by at most one limit.
    const std::int32_t change = passed_stop_ ? 0 : conditions.oldest_step - oldest_step_;
    const float before = static_cast<float>(change) / (kPathUnitsPerTick * kServoTick);
    const float reach = present + ahead.first->envelope.limit.at_rest * kServoTick;
    const Bounds bound = bounds(ahead, reach, factors);
    // Neither a higher speed is allowed nor a lower one wanted than the envelope asks for.
    if (bound.feed >= present && std::min(bound.speed, bound.feed) <= present) {
        return std::min(bound.speed, present);
    }
    const float most = acceleration(ahead.begin, bound.last);
    const float up = std::max(0.0F, most - std::max(0.0F, -before));
    const float down = conditions.may_brake ? std::max(0.0F, most - std::max(0.0F, before)) : 0.0F;
    const float slowest = std::max(0.0F, present - down * kServoTick);
    float wanted = present + up * kServoTick;
    wanted = std::min(wanted, std::max(slowest, bound.feed));
    wanted = std::min(wanted, bound.speed);
    if (wanted > present) {
        wanted = std::max(present, coasting_speed(wanted, factors));
        wanted = std::min(wanted, std::max(bound.speed, slowest));
    }
    return wanted;
}

// The greatest speed up to `wanted` that can surely be kept for one path filter: where the envelope
// falls below `wanted` over the travel at that speed, by a look at the nearest intervals.
float PathServo::coasting_speed(float wanted, const OverrideFactors& factors) noexcept
{
    const auto ticks = static_cast<float>(filter_ + 2);
    const auto travel = static_cast<std::uint64_t>(wanted * kPathUnitsPerTick * ticks);
    const std::uint32_t begin = queue_.interval_begin();
    if (!speed_window_.started() ||
        queue_.take_changed_from() - begin <= speed_window_.interval() - begin ||
        speed_window_.interval() - begin > planner::kIntervalCount) {
        speed_window_.restart(begin, position_ - offset_ + queue_.interval(begin).length);
    }
    const float least = speed_window_.least_between(queue_, position_, position_ + travel, factors);
    if (least >= wanted * wanted) {
        return wanted;
    }
    return std::min(wanted, std::max(std::sqrt(std::max(least, 0.0F)),
                                     kept_speed(ticks * kServoTick, factors)));
}

// The greatest speed v that the envelope allows all over its own travel v time; no more than what
// passes the nearest intervals in that time.
float PathServo::kept_speed(float time, const OverrideFactors& factors) const noexcept
{
    constexpr std::uint32_t kIntervalsToLookAt = 8;
    float least = kUnlimited;  // squared speed allowed before the interval
    float to_begin = 0;
    for (std::uint32_t i = 0; i < kIntervalsToLookAt; ++i) {
        const std::uint32_t index = queue_.interval_begin() + i;
        if (index == queue_.published()) {
            break;
        }
        const Interval& interval = queue_.interval(index);
        const float to_end = to_begin + millimetres(interval.length - (i == 0 ? offset_ : 0U));
        // v^2 <= braking - 2 slope v time, without the cancellation that would stop it short of
        // the end.
        const float braking = std::max(0.0F, braking_before_end(interval, to_end, factors));
        const float drop = interval.envelope.slope * time;
        const float falling = braking / (std::sqrt(drop * drop + braking) + drop);
        least = std::min(least, cap_of(interval, factors));
        const float kept = lower_root(std::max(0.0F, least), falling);
        if (kept * time <= to_end) {
            return std::max(kept, to_begin / time);
        }
        least = std::min(least, braking_before_end(interval, 0.0F, factors));
        to_begin = to_end;
    }
    return to_begin / time;
}

inline std::int32_t PathServo::advance(const Ahead& ahead, float speed) noexcept
{
    const float travel = speed * kPathUnitsPerTick + residue_;
    auto step = static_cast<std::uint32_t>(travel);
    residue_ = travel - static_cast<float>(step);
    // Never past a stop or the end of what is published.
    std::uint32_t index = ahead.begin;
    std::uint32_t left = ahead.first->length - offset_;
    while (step + kArrived > left && !queue_.interval(index).stop_at_end &&
           index + 1 != ahead.published) {
        ++index;
        left += queue_.interval(index).length;
    }
    if (step + kArrived >= left) {
        step = left;
        residue_ = 0;
    }
    offset_ += step;
    position_ += step;
    travelled_.store(static_cast<std::uint32_t>(position_ >> 8U), std::memory_order_relaxed);
    return static_cast<std::int32_t>(step);
}

}  // namespace cusp::interpolator
