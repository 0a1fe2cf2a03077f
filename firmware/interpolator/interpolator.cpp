// One set point a tick.
#include "firmware/interpolator/interpolator.hpp"

namespace cusp::interpolator {
namespace {

float squared_part(unsigned percent) noexcept
{
    const float part = static_cast<float>(percent) / 100.0F;
    return part * part;
}

}  // namespace

Interpolator::Interpolator(planner::Planner& planner) noexcept
    : planner_{planner}, queue_{planner.queue()}, servo_{planner.queue()}
{
    reset({});
}

void Interpolator::reset(Position at) noexcept
{
    const std::uint32_t ticks = planner_.path_filter();
    servo_.reset(ticks);
    path_filter_.clear();
    path_filter_.set_length(ticks);
    path_division_.set(static_cast<std::int32_t>(ticks), 0);
    for (AxisState& axis : axes_) {
        axis.first.clear();
        axis.second.clear();
    }
    set_axis_filter(axis_filter_);
    offset_ = 0;
    place_ = {};
    position_ = at;
    along_ = 0;
    holding_ = false;
    at_rest_ = true;
}

void Interpolator::set_axis_filter(planner::AxisFilter filter) noexcept
{
    axis_filter_ = filter;
    const std::int32_t divisor = kPathUnitsPerNanometre * filter.first * filter.second;
    for (AxisState& axis : axes_) {
        axis.first.set_length(filter.first);
        axis.second.set_length(filter.second);
        // Half a divisor: to the nearest nanometre.
        axis.division.set(divisor, divisor / 2);
    }
}

bool Interpolator::filters_drained() const noexcept
{
    bool drained = path_filter_.drained();
    for (const AxisState& axis : axes_) {
        drained = drained && axis.first.drained() && axis.second.drained();
    }
    return drained;
}

Position Interpolator::tick() noexcept
{
    const OverrideFactors factors = holding_ ? OverrideFactors{0, 0} : factors_;
    const std::int32_t step = servo_.tick(factors, ready_to_go_on());
    along_ = path_division_.divide(path_filter_.add(step));
    const PathOffset moved = travel(along_);
    for (unsigned i = 0; i < kAxisCount; ++i) {
        AxisState& axis = axes_[i];
        position_[i] += axis.division.divide(axis.second.add(axis.first.add(moved[i])));
    }
    at_rest_ = servo_.standing() && filters_drained();
    return position_;
}

// Whether the path may go on after a stop: the tool stands there. Its axis filters need not be
// empty: with no speed and no acceleration left they leave the corner by less than a nanometre.
// They must be where the next block has others.
bool Interpolator::ready_to_go_on() noexcept
{
    if (!servo_.standing() || !path_filter_.drained()) {
        return false;
    }
    if (queue_.block_begin() == queue_.block_end() || offset_ != 0 ||
        queue_.block(queue_.block_begin()).filter == axis_filter_) {
        return true;
    }
    if (at_rest_) {
        set_axis_filter(queue_.block(queue_.block_begin()).filter);
    }
    return at_rest_;
}

// Moves on along the blocks and returns by how much, per axis, path units.
PathOffset Interpolator::travel(std::int32_t along) noexcept
{
    if (along == 0) {
        return {};
    }
    PathOffset before = place_;
    offset_ += static_cast<std::uint32_t>(along);
    while (queue_.block_begin() != queue_.block_end()) {
        const planner::Block& block = queue_.block(queue_.block_begin());
        line_ = block.line;
        if (offset_ < block.length) {
            place_ = planner::position_at(block, offset_);
            return place_ - before;
        }
        offset_ -= block.length;
        before = before - block.displacement;
        queue_.drop_block();
    }
    place_ = {};
    return place_ - before;
}

void Interpolator::set_feed_override(unsigned percent) noexcept
{
    factors_.feed = squared_part(percent);
}

void Interpolator::set_rapid_override(unsigned percent) noexcept
{
    factors_.rapid = squared_part(percent);
}

float Interpolator::speed() const noexcept
{
    return static_cast<float>(along_) / kPathUnitsPerTick;
}

}  // namespace cusp::interpolator
