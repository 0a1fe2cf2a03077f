// One set point a tick.
#include "firmware/interpolator/interpolator.hpp"

#include <utility>

namespace cusp::interpolator {
namespace {

constexpr OverrideFactors kHeld{{0, 0, 0}};

float squared_part(unsigned percent) noexcept
{
    const float part = static_cast<float>(percent) / 100.0F;
    return part * part;
}

}  // namespace

Interpolator::Interpolator(planner::Planner& planner) noexcept
    : planner_{planner}, queue_{planner.queue()}, servo_{planner.queue()}, shaper_{planner.shaper()}
{
    leading_ = &tracks_[0];
    trailing_ = &tracks_[1];
    reset({});
}

void Interpolator::reset(Position at) noexcept
{
    const std::uint32_t ticks = planner_.path_filter();
    servo_.reset(ticks);
    for (Track& track : tracks_) {
        track.filter.clear();
        track.filter.set_length(ticks);
        track.division.set(static_cast<std::int32_t>(ticks), 0);
        track.block = queue_.block_begin();
        track.offset = 0;
        track.place = {};
    }
    first_.clear();
    second_.clear();
    shaper_.reset();
    shaper_ticks_ = planner_.shaper().ticks / 2U;
    set_axis_filter(axis_filter_);
    position_ = at;
    drained_ = true;
    drained_before_ = true;
    trail_drained_ = true;
    along_ = 0;
    power_ = {};
    holding_ = false;
    at_rest_ = true;
}

void Interpolator::set_axis_filter(planner::AxisFilter filter) noexcept
{
    axis_filter_ = filter;
    const std::int32_t divisor = kPathUnitsPerNanometre * filter.first * filter.second;
    first_.set_length(filter.first);
    second_.set_length(filter.second);
    for (ExactDivision& division : axis_division_) {
        // Half a divisor: to the nearest nanometre.
        division.set(divisor, divisor / 2);
    }
}

bool Interpolator::filters_drained() const noexcept
{
    return leading_->filter.drained() && trailing_->filter.drained() && first_.drained() &&
           second_.drained() && shaper_.drained();
}

Position Interpolator::tick() noexcept
{
    drained_before_ = drained_;
    drained_ = leading_->filter.drained();
    const OverrideFactors& factors = holding_ || braking_ ? kHeld : factors_;
    const bool may_pass = servo_.standing() && ready_to_go_on();
    const std::int32_t step =
        servo_.tick({factors, may_pass, trail_drained_, leading_->filter.oldest()});
    trail_drained_ = trailing_->filter.drained();
    if (servo_.passed_stop()) {
        change_track();
        drop_passed_blocks();
        drained_ = false;
        trail_drained_ = trailing_->filter.drained();
    }
    const bool trails = !trail_drained_;
    PathOffset behind;
    along_ = 0;
    if (trails) {
        behind = trail();
    }
    PathOffset moved = travel(*leading_, step);
    if (trails) {
        moved = moved + behind;
        drop_passed_blocks();
    }
    PathOffset smooth = second_.add(first_.add(moved));
    if (shaper_.on()) {
        smooth = shaper_.add(smooth);
    }
    position_.x += axis_division_[0].divide(smooth.x);
    position_.y += axis_division_[1].divide(smooth.y);
    position_.z += axis_division_[2].divide(smooth.z);
    at_rest_ = servo_.standing() && filters_drained();
    return position_;
}

// True if the path may continue after a stop: the tool is there, or is so near that the corner may
// be cut. The last jerk of the old and the first of the new stretch take a tick each: with none
// between them they fall on the same one, which only an overlap allows for. The axis filters need
// not be empty: with no speed and no acceleration left they leave the corner by less than a
// nanometre. They must be where the next block has others.
// Precondition: the servo is at rest.
bool Interpolator::ready_to_go_on() noexcept
{
    if (!trailing_->filter.drained()) {
        return false;
    }
    // A shaper reaches too far for that: what it holds is on the path before the stop.
    if (shaper_.on() && !filters_drained()) {
        return false;
    }
    std::uint32_t next = leading_->block;
    if (!leading_->filter.drained()) {
        const planner::Interval& here = queue_.interval(queue_.interval_begin());
        return queue_.interval_begin() != queue_.published() &&
               leading_->filter.ticks_left() < here.overlap && find_stop(next);
    }
    if (!drained_before_) {
        return false;
    }
    if (next == queue_.block_end() || leading_->offset != 0 ||
        queue_.block(next).filter == axis_filter_) {
        return true;
    }
    if (at_rest_) {
        set_axis_filter(queue_.block(next).filter);
    }
    return at_rest_;
}

// The block at whose end the leading track stops. False where too many blocks come before it.
bool Interpolator::find_stop(std::uint32_t& block) const noexcept
{
    constexpr std::uint32_t kBlocksToLookAt = 16;
    for (std::uint32_t i = 0; i < kBlocksToLookAt; ++i) {
        block = leading_->block + i;
        if (block == queue_.block_end()) {
            return false;
        }
        if (queue_.block(block).stops) {
            return true;
        }
    }
    return false;
}

// The path continues after a stop: the other track follows it.
void Interpolator::change_track() noexcept
{
    std::uint32_t next = leading_->block;
    if (!leading_->filter.drained() && find_stop(next)) {
        ++next;
    }
    std::swap(leading_, trailing_);
    leading_->block = next;
    leading_->offset = 0;
    leading_->place = {};
}

// Moves a track on along its blocks. Returns by how much, per axis, path units.
[[gnu::always_inline]] inline PathOffset Interpolator::travel(Track& track,
                                                              std::int32_t step) noexcept
{
    const std::int32_t along = track.division.divide(track.filter.add(step));
    along_ += along;
    if (along == 0) {
        return {};
    }
    const std::uint32_t offset = track.offset + static_cast<std::uint32_t>(along);
    const planner::Block& block = queue_.block(track.block);
    if (track.block == queue_.block_end() || offset >= block.length) {
        return pass_blocks(track, offset);
    }
    line_ = block.line;
    power_ = block.power;
    const PathOffset place = planner::position_at(block, offset);
    const PathOffset moved = place - track.place;
    track.offset = offset;
    track.place = place;
    return moved;
}

// As travel(), to an offset that is not in the track's block, if there is one.
PathOffset Interpolator::pass_blocks(Track& track, std::uint32_t offset) noexcept
{
    PathOffset before = track.place;
    PathOffset place{};
    while (track.block != queue_.block_end()) {
        const planner::Block& block = queue_.block(track.block);
        line_ = block.line;
        power_ = block.power;
        if (offset < block.length) {
            place = planner::position_at(block, offset);
            break;
        }
        offset -= block.length;
        before = before - block.displacement;
        ++track.block;
        if (block.stops) {
            break;
        }
    }
    track.offset = offset;
    track.place = place;
    drop_passed_blocks();
    return place - before;
}

// The trailing track, where it still moves.
PathOffset Interpolator::trail() noexcept { return travel(*trailing_, 0); }

// After a track has passed a block, or has drained.
void Interpolator::drop_passed_blocks() noexcept
{
    const Track& last = trailing_->filter.drained() ? *leading_ : *trailing_;
    while (queue_.block_begin() != last.block) {
        queue_.drop_block();
    }
}

void Interpolator::set_feed_override(unsigned percent) noexcept
{
    factors_.set(path::MoveKind::kFeed, squared_part(percent));
}

void Interpolator::set_rapid_override(unsigned percent) noexcept
{
    factors_.set(path::MoveKind::kRapid, squared_part(percent));
}

float Interpolator::speed() const noexcept
{
    return static_cast<float>(along_) / kPathUnitsPerTick;
}

}  // namespace cusp::interpolator
