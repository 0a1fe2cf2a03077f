// A block's stretches, one after the other, become intervals.
#include <algorithm>

#include "firmware/planner/planner.hpp"
#include "firmware/planner/rounding_margin.hpp"

namespace cusp::planner {
namespace {

// A stretch that is passed in less time, s, gains nothing by limits of its own.
constexpr float kShortestStretch = kServoTick;
constexpr float kGreatestSpeed = 2000.0F;  // mm/s

// Part of an axis' jerk that bends may take.
float jerk_share(const path::Move& move) noexcept
{
    const auto* quintic = std::get_if<path::Quintic>(&move.path);
    if (quintic == nullptr) {
        return kCurvatureJerkShare;
    }
    return quintic->is_transition ? kTransitionJerkShare : kSmoothedJerkShare;
}

}  // namespace

Allowance Planner::allowance_of(const Block& block, const Stretch& part) const noexcept
{
    const float filter_s = static_cast<float>(path_filter_) * kServoTick;
    const float feed = std::min(move_.feed, kGreatestSpeed);
    const auto within = [&](const MachineLimits& limits) {
        Allowance of_part = allowance(part.derivatives, limits, filter_s, choice_.centripetal,
                                      kGreatestSpeed, jerk_share(move_));
        // An override of rapids scales the speed that the axes allow.
        of_part.feed = block.kind == path::MoveKind::kRapid ? of_part.cap : feed * feed;
        return of_part;
    };
    if (block.shape != BlockShape::kCurve) {
        return within(limits_);
    }
    MachineLimits limits = limits_;
    leave_to_rounding(limits, block.filter);
    return within(limits);
}

void Planner::read_stretch() noexcept
{
    ahead_->stretch = ahead_->reader.next();
    ahead_->allowance = allowance_of(ahead_->reader.block(), ahead_->stretch);
}

// Adds the next stretch of the last block, and those behind it that allow nearly the same.
void Planner::add_stretch() noexcept
{
    const StretchAhead& ahead = *ahead_;
    const Block& block = ahead.reader.block();
    const std::uint32_t begin = next_stretch_ == 0 ? 0 : stretch_end_;
    Stretch whole = ahead.stretch;
    const Allowance of_first = ahead.allowance;
    Allowance allowed = of_first;
    while (++next_stretch_ != stretches_) {
        read_stretch();
        const float length = static_cast<float>(whole.end - begin) / kPathUnitsPerMillimetre;
        const bool is_short = length < kShortestStretch * greatest_speed(allowed, block.kind);
        if (!is_short && !are_alike(of_first, ahead.allowance)) {
            break;
        }
        whole.end = ahead.stretch.end;
        whole.derivatives = larger(whole.derivatives, ahead.stretch.derivatives);
        restrict_to(allowed, ahead.allowance);
    }
    stretch_end_ = whole.end;
    if (whole.end == begin) {
        return;
    }
    const PathDerivatives bounds = to_vec(whole.derivatives);
    apply_junction_limits(bounds);
    spread_bend(bounds.second);
    builder_.append(whole.end - begin, allowed, block.kind);
    spread_bend(bounds.second);
    age_bounds(bounds, static_cast<float>(whole.end - begin) / kPathUnitsPerMillimetre);
    end_speed_ = greatest_speed(allowed, block.kind);
}

}  // namespace cusp::planner
