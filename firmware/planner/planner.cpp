// Moves in, path queue out.
#include "firmware/planner/planner.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/planner/rounding_margin.hpp"

namespace cusp::planner {
namespace {

// A change of direction above this is a corner: the exact path stops there. 0.5 degrees.
constexpr float kCornerTurn = 0.00872665F;
// Slower than this, passing a junction takes longer than stopping at it.
constexpr float kLeastJunctionSpeed = 1.5F;  // mm/s
// Part of the axes' limits that a joint may take at that speed.
constexpr float kJointShare = 0.5F;

// Deviation, mm, left to the axis filters on the exact path and as a share of a tolerance.
constexpr float kExactDeviation = 0.0009F;
constexpr float kFilterShareOfTolerance = 0.18F;
// As a share of it where the filters can't be so short, or a shaper is behind them.
constexpr float kMostFilterShareOfTolerance = 0.45F;
// Deviation of all together.
constexpr float kUseOfTolerance = 0.985F;
constexpr float kGreatestSpeed = 2000.0F;  // mm/s
// The law keeps about so far from a squared speed that it may have.
constexpr float kFeedOfBarrier = 1.0004F;

constexpr float kLongestFilterTicks = 22.0F;
// Positions on arcs and curves are off by up to half a nanometre, third differences by 4 and,
// rounded once more, 8. Divided by the filters' lengths, n and 2, this is to be 1 % of the least
// jerk; behind 4 ticks it is a nanometre at most, which is to be an eighth of it.
constexpr float kRoughJerk = 4e5F;
constexpr float kFilterForRoughness = 4.0F;
constexpr float kRoughestJerk = 3.2e4F;

// Two boxes of n and m ticks leave a circle by a (n^2 + m^2 - 2)/24 ticks^2: a box of one tick does
// nothing.
float circle_factor(AxisFilter filter) noexcept
{
    const auto first = static_cast<float>(filter.first);
    const auto second = static_cast<float>(filter.second);
    return (first * first + second * second - 2.0F) * (kServoTick * kServoTick / 24.0F);
}

// Travel along the path while the tool travels 1 mm: the feed is that of X, Y and Z, unless A moves alone.
float travel_a_feed(const Block& block) noexcept
{
    float least = 1.0F;
    if constexpr (kHasRotaryAxis) {
        const auto at = [](const AxisVecf& along) {
            const float linear = norm(xyz(along));
            return along[kLinearAxes] != 0 && linear > 0 ? norm(along) / linear : 1.0F;
        };
        least = std::min(at(start_geometry(block).tangent), at(end_geometry(block).tangent));
    }
    return least;
}

}  // namespace

// The longest filter that leaves a circle at the greatest acceleration of all axes by no more than its
// part of the tolerance, but long enough to smooth the rounding of positions. What such a filter and
// the shaper do not need of the tolerance is for the path.
Planner::FilterChoice Planner::filter_for(float tolerance) const noexcept
{
    const float deviation = std::max(kExactDeviation, kFilterShareOfTolerance * tolerance);
    constexpr float kSecond = 2.0F;
    const float square = deviation * 24.0F / (whole_acceleration_ * kServoTick * kServoTick) -
                         kSecond * kSecond + 2.0F;
    const float ticks = std::clamp(std::sqrt(std::max(square, 1.0F)), 1.0F, kLongestFilterTicks);
    const auto first = static_cast<std::uint8_t>(std::max(ticks, least_filter_));
    const AxisFilter filter{first, first > 1 ? std::uint8_t{2} : std::uint8_t{1}};
    const float factor = std::max(circle_factor(filter) + 0.5F * shaper_.square, 1e-12F);
    const float most = std::max(kExactDeviation, kMostFilterShareOfTolerance * tolerance);
    const float kept = std::min(factor * whole_acceleration_, most);
    return {filter, std::max(kUseOfTolerance * tolerance - kept, 0.0F), kept / factor};
}

void Planner::set_limits(const MachineLimits& limits) noexcept
{
    float longest = 0;
    float least_jerk = kUnlimited;
    greatest_acceleration_ = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        longest = std::max(longest, limits.acceleration[i] / limits.jerk[i]);
        greatest_acceleration_ = std::max(greatest_acceleration_, limits.acceleration[i]);
        least_jerk = std::min(least_jerk, limits.jerk[i]);
    }
    least_filter_ = std::clamp(std::ceil(kRoughJerk / least_jerk), 1.0F, kFilterForRoughness);
    least_filter_ =
        std::clamp(std::ceil(kRoughestJerk / least_jerk), least_filter_, kLongestFilterTicks);
    whole_acceleration_ = limits.whole_acceleration();
    limits_ = with_margin(limits);
    blender_.set_limits(limits_, longest);
    law_.set_limits(limits_);
}

void Planner::reset(Position at) noexcept
{
    queue_.clear();
    law_.reset();
    maker_ = BlockMaker{};
    smoother_.clear();
    blender_.clear();
    waiting_.reset();
    end_.reset();
    end_length_ = 0;
    close_requested_ = false;
    tail_ = at;
}

bool Planner::has_room() const noexcept { return !waiting_ && !smoother_.full(); }

void Planner::push(const path::Move& move) noexcept
{
    CUSP_ASSERT(has_room());
    CUSP_ASSERT(move.start == tail_);
    close_requested_ = false;
    tail_ = move.end;
    if (LineSmoother::accepts(move) && smoother_.continues(move)) {
        smoother_.add(move, filter_for(move.tolerance).departure);
    } else {
        waiting_ = move;
    }
}

void Planner::close() noexcept { close_requested_ = true; }

bool Planner::empty() const noexcept
{
    return maker_.done() && !waiting_ && smoother_.empty() && blender_.empty() &&
           queue_.block_begin() == queue_.block_end();
}

void Planner::start() noexcept
{
    within_move_ = false;
    choice_ = filter_for(move_.tolerance);
    maker_.start(move_, choice_.filter);
}

// True if the published path could be over in a tenth of a second.
bool Planner::path_is_short() const noexcept
{
    constexpr float kShort = 0.1F;  // s
    return law_.has_all() && queue_.plans().certain_way().time < kShort;
}

// The next move after smoothing: of the run of lines first, then the one that ended it.
bool Planner::next_smoothed(path::Move& move) noexcept
{
    using Patience = LineSmoother::Patience;
    const bool ends = waiting_.has_value() || close_requested_;
    const Patience patience = flushing_ ? Patience::kShort : Patience::kFull;
    if (smoother_.next(ends ? Patience::kNone : patience, move)) {
        return true;
    }
    if (!waiting_) {
        return false;
    }
    if (LineSmoother::accepts(*waiting_)) {
        smoother_.add(*waiting_, filter_for(waiting_->tolerance).departure);
        waiting_.reset();
        return smoother_.next(close_requested_ ? Patience::kNone : patience, move);
    }
    move = *waiting_;
    waiting_.reset();
    return true;
}

// Takes the next move to cut into blocks. Precondition: the one before is cut: while none is found
// its place serves those on their way.
bool Planner::next_move() noexcept
{
    while (!blender_.next(false, move_)) {
        if (next_smoothed(move_)) {
            const FilterChoice choice = filter_for(move_.tolerance);
            blender_.add(move_,
                         {static_cast<float>(choice.filter.first) * kServoTick, choice.departure});
            continue;
        }
        const bool ending = close_requested_ && !waiting_ && smoother_.empty();
        if (!blender_.next(ending, move_)) {
            return false;
        }
        break;
    }
    start();
    return true;
}

bool Planner::work(bool late) noexcept
{
    flushing_ = late && path_is_short();
    const bool made = go_on();
    return law_.work() || made;
}

// Makes blocks as far as there is room and moves are at hand.
bool Planner::go_on() noexcept
{
    bool made = false;
    while (queue_.free_blocks() > 0 && queue_.free_curves() > 0) {
        if (maker_.done() && !next_move()) {
            break;
        }
        Block& block = queue_.new_block();
        if (!maker_.done() && maker_.make(move_, queue_, block)) {
            add_block(block);
            made = true;
        }
    }
    const bool all_done = maker_.done() && !waiting_ && smoother_.empty() && blender_.empty();
    if (all_done && close_requested_) {
        end_in_stop({0, false, full_stop(limits_)});
        close_requested_ = false;
        made = true;
    }
    return made;
}

// The block lies where the queue has the next.
void Planner::add_block(Block& block) noexcept
{
    const float feed = block.kind == path::MoveKind::kRapid
                           ? kGreatestSpeed
                           : std::min(move_.feed * travel_a_feed(block), kGreatestSpeed);
    block.feed = feed * feed * kFeedOfBarrier;
    block.centripetal = choice_.centripetal;
    // Only rounding makes a jump where one line or arc was cut into blocks.
    const bool goes_on = within_move_ && block.shape != BlockShape::kCurve;
    if (end_ && !goes_on) {
        join(start_geometry(block), block);
    }
    within_move_ = true;
    queue_.append_block();
    end_ = end_geometry(block);
    if (is_within_half_tick(block, std::min(feed, limits_.whole_velocity()))) {
        end_->tangent = felt_end(block, start_geometry(block).tangent, end_->tangent);
    }
    end_length_ += static_cast<float>(block.length) / kPathUnitsPerMillimetre;
    end_deviation_ = kUseOfTolerance * move_.tolerance;
    end_departure_ = move_.departure;
    end_lean_ = move_.end_lean;
}

void Planner::join(const EndGeometry& after, const Block& block) noexcept
{
    const Block& last = queue_.block(queue_.block_end() - 1);
    const float turn = norm(after.tangent - end_->tangent);
    if (turn > kCornerTurn || last.filter != block.filter) {
        end_in_stop(overlap_at_corner(after, block));
    } else if (must_stop(after, block)) {
        end_in_stop({0, false, full_stop(limits_)});
    }
}

// True if the filters do not take the jump of direction at any speed that is worth it.
bool Planner::must_stop(const EndGeometry& after, const Block& block) const noexcept
{
    const float first = static_cast<float>(block.filter.first) * kServoTick;
    const float second = static_cast<float>(block.filter.second) * kServoTick;
    float most = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const float turn = std::fabs(after.tangent[i] - end_->tangent[i]);
        const float by_speed = turn * kLeastJunctionSpeed / first;
        const float change = greatest_acceleration_ * turn / first;
        most = std::max(most, (by_speed / second + change) / limits_.jerk[i]);
        most = std::max(most, by_speed / limits_.acceleration[i]);
    }
    return most > kJointShare;
}

// Overlap in time at the corner at the end of the path so far. None with a shaper, which drains.
CornerOverlap Planner::overlap_at_corner(const EndGeometry& after,
                                         const Block& block) const noexcept
{
    const float deviation = std::min(end_deviation_, kUseOfTolerance * move_.tolerance);
    const Block& last = queue_.block(queue_.block_end() - 1);
    if (deviation <= 0 || shaper_.on() || last.filter != block.filter ||
        block.shape == BlockShape::kCurve || block.power != last.power) {
        return {0, false, full_stop(limits_)};
    }
    (void)after;
    const float length = static_cast<float>(block.length) / kPathUnitsPerMillimetre;
    const float before = static_cast<float>(last.length) / kPathUnitsPerMillimetre;
    return corner_overlap(
        {derivatives_at(last, before), end_length_, before, end_departure_, end_lean_},
        {derivatives_at(block, 0.0F), length, length, move_.departure, move_.start_lean}, limits_,
        block.filter, deviation);
}

void Planner::end_in_stop(const CornerOverlap& overlap) noexcept
{
    if (end_) {
        Block& last = queue_.block(queue_.block_end() - 1);
        last.overlap = static_cast<std::uint16_t>(overlap.time / kOverlapUnit);
        last.disjoint = overlap.disjoint;
        last.share = static_cast<std::uint16_t>(overlap.stop.share * kWholeShare);
        last.stops = true;
    }
    end_.reset();
    end_length_ = 0;
}

}  // namespace cusp::planner
