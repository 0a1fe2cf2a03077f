// Moves in, path queue out.
#include "firmware/planner/planner.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/planner/look_ahead.hpp"
#include "firmware/planner/rounding_margin.hpp"

namespace cusp::planner {
namespace {

// A change of direction above this is a corner: the exact path stops there. 0.5 degrees.
constexpr float kCornerTurn = 0.00872665F;
// Slower than this, passing a junction takes longer than stopping at it.
constexpr float kLeastJunctionSpeed = 1.5F;  // mm/s
// Share of the axes' acceleration and jerk for a junction; the rest is for the curves around it.
// Near a single junction the speed hardly changes; in dense runs it must.
constexpr float kLoneJunctionShare = 0.98F;
constexpr float kDenseJunctionShare = 0.8F;
// Free intervals that a stretch may take.
constexpr std::uint32_t kIntervalsOfAStretch = 2 * IntervalBuilder::kMostPerAppend;

// Deviation, mm, left to the axis filters on the exact path and as a share of a tolerance.
constexpr float kExactDeviation = 0.0009F;
constexpr float kFilterShareOfTolerance = 0.45F;
// Deviation by which a corner may be cut, less that of the path itself.
constexpr float kCornerShareOfTolerance = 0.985F;
// Ticks between the place of the tool and the middle of what the servo did: jerk is a difference of
// four set points, and the servo looks at where it was a tick ago.
constexpr float kTicksOfJerk = 1.5F;
// A junction that takes less of the axes' jerk is none.
constexpr float kNegligible = 1e-3F;

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

// True if the bounds that a junction was made with hold for the stretch too, within a hundredth.
bool is_covered_by(const Junction& junction, const PathDerivatives& stretch) noexcept
{
    constexpr float kSlack = 1.01F;
    bool all = true;
    for (unsigned i = 0; i < 3; ++i) {
        all = all && stretch.second[i] <= kSlack * junction.second[i] &&
              stretch.third[i] <= kSlack * junction.third[i];
    }
    return all;
}

}  // namespace

// The longest filter that leaves a circle at the axes' greatest acceleration by no more than its
// part of the tolerance, but long enough to smooth the rounding of positions.
Planner::FilterChoice Planner::filter_for(float tolerance) const noexcept
{
    const float deviation = std::max(kExactDeviation, kFilterShareOfTolerance * tolerance);
    constexpr float kSecond = 2.0F;
    const float square = deviation * 24.0F / (greatest_acceleration_ * kServoTick * kServoTick) -
                         kSecond * kSecond + 2.0F;
    const float ticks = std::clamp(std::sqrt(std::max(square, 1.0F)), 1.0F, kLongestFilterTicks);
    const auto first = static_cast<std::uint8_t>(std::max(ticks, least_filter_));
    const AxisFilter filter{first, first > 1 ? std::uint8_t{2} : std::uint8_t{1}};
    const float factor = circle_factor(filter) + 0.5F * shaper_.square;
    return {filter, deviation, deviation / std::max(factor, 1e-12F)};
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
    path_filter_ = std::clamp(static_cast<std::uint32_t>(std::ceil(longest / kServoTick - 0.001F)),
                              std::uint32_t{1}, kMaxPathFilter);
    least_filter_ = std::clamp(std::ceil(kRoughJerk / least_jerk), 1.0F, kFilterForRoughness);
    least_filter_ =
        std::clamp(std::ceil(kRoughestJerk / least_jerk), least_filter_, kLongestFilterTicks);
    limits_ = with_margin(limits, path_filter_);
    blender_.set_limits(limits_, static_cast<float>(path_filter_) * kServoTick);
    queue_.set_half_filter(0.5F * static_cast<float>(path_filter_) * kServoTick);
}

void Planner::reset(Position at) noexcept
{
    queue_.clear();
    builder_.clear();
    maker_ = BlockMaker{};
    smoother_.clear();
    blender_.clear();
    waiting_.reset();
    junctions_.clear();
    bends_.clear();
    end_.reset();
    end_length_ = 0;
    close_requested_ = false;
    starved_ = false;
    ahead_.reset();
    next_stretch_ = 0;
    stretches_ = 0;
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
        smoother_.add(move);
        starved_ = starved_ && !smoother_.full();
    } else {
        waiting_ = move;
        starved_ = false;
    }
}

void Planner::close() noexcept
{
    close_requested_ = true;
    starved_ = false;
}

bool Planner::empty() const noexcept
{
    return maker_.done() && next_stretch_ == stretches_ && !waiting_ && smoother_.empty() &&
           blender_.empty() && queue_.block_begin() == queue_.block_end();
}

void Planner::start() noexcept
{
    within_move_ = false;
    choice_ = filter_for(move_.tolerance);
    const AxisFilter filter = choice_.filter;
    maker_.start(move_, filter);
    // The path stops where the axis filters change: no limit is spread over that.
    const float beyond = queue_.half_filter() + 2.0F * kServoTick + window_of(filter);
    builder_.set_reach({queue_.half_filter() + kTicksOfJerk * kServoTick, beyond, beyond});
}

// True if the published path could be over in a tenth of a second.
bool Planner::path_is_short() const noexcept
{
    constexpr std::uint32_t kShort = 1'000'000;  // units of 0.1 us
    std::uint32_t time = 0;
    for (std::uint32_t i = queue_.interval_begin(); i != queue_.published(); ++i) {
        time += queue_.interval(i).least_time;
        if (time > kShort) {
            return false;
        }
    }
    return true;
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
        smoother_.add(*waiting_);
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
            const AxisFilter filter = filter_for(move_.tolerance).filter;
            blender_.add(move_, static_cast<float>(filter.first) * kServoTick);
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

void Planner::work(bool late) noexcept
{
    flushing_ = late && path_is_short();
    starved_ = starved_ && !flushing_;
    if (!waits()) {
        go_on();
    }
}

// True if there is nothing to do: no room, or no move. It is asked at every poll.
bool Planner::waits() const noexcept
{
    const PathQueue& queue = queue_;  // each atomic read would fetch the reference again
    const std::uint32_t begin = queue.interval_begin();
    if (close_requested_ || queue.published() == begin) {
        return false;
    }
    return starved_ || kIntervalCount - (queue.interval_end() - begin) <= kIntervalsOfAStretch ||
           (next_stretch_ == stretches_ && (queue.free_blocks() == 0 || queue.free_curves() == 0));
}

void Planner::go_on() noexcept
{
    bool changed = false;
    while (queue_.free_intervals() > kIntervalsOfAStretch) {
        if (next_stretch_ != stretches_) {
            add_stretch();
            changed = true;
            continue;
        }
        if (queue_.free_blocks() == 0 || queue_.free_curves() == 0) {
            break;
        }
        if (maker_.done() && !next_move()) {
            starved_ = true;
            break;
        }
        Block& block = queue_.new_block();
        if (!maker_.done() && maker_.make(move_, queue_, block)) {
            next_stretch_ = 0;
            stretches_ = static_cast<std::uint8_t>(stretch_count(block));
            ahead_.emplace(block);
            read_stretch();
            add_block(block);
        }
    }
    const bool cut = maker_.done() && next_stretch_ == stretches_;
    const bool all_done = cut && !waiting_ && smoother_.empty() && blender_.empty();
    if (all_done && close_requested_) {
        end_in_stop({});
        close_requested_ = false;
        changed = true;
    }
    // Without news there is nothing to publish, but where the whole queue is too short for it.
    if (changed || queue_.published() == queue_.interval_begin()) {
        builder_.publish(!cut);
        look_ahead(queue_);
    }
}

// The block lies where the queue has the next.
void Planner::add_block(const Block& block) noexcept
{
    // Only rounding makes a jump where one line or arc was cut into blocks.
    const bool goes_on = within_move_ && block.shape != BlockShape::kCurve;
    if (end_ && !goes_on) {
        join(start_geometry(block), block, ahead_->stretch, ahead_->allowance);
    }
    within_move_ = true;
    const BlockShape before = queue_.block(queue_.block_end() - 1).shape;
    queue_.append_block();
    end_ = end_geometry(block);
    end_filter_ = block.filter;
    const float length = static_cast<float>(block.length) / kPathUnitsPerMillimetre;
    if (block.shape == BlockShape::kCurve) {
        end_length_ = 0;
    } else {
        const bool bends = BlockShape::kQuintic == block.shape || BlockShape::kQuintic == before;
        end_length_ = (bends ? 0.0F : end_length_) + length;
    }
    end_left_ = kCornerShareOfTolerance * move_.tolerance - move_.departure;
}

void Planner::join(const EndGeometry& after,
                   const Block& block,
                   const Stretch& first,
                   const Allowance& of_first) noexcept
{
    const float fastest = std::min(end_speed_, greatest_speed(of_first, block.kind));
    const float window = window_of(end_filter_);
    const Junction junction = make_junction(
        *end_, after, larger(bounds_behind(fastest * window), to_vec(first.derivatives)));
    if (junction.turn > kCornerTurn || end_filter_ != block.filter) {
        end_in_stop(overlap_at_corner(after, block));
        return;
    }
    JunctionShare share = share_of(junction, junctions_.size(), 0.0F, fastest);
    if (share.speed < kLeastJunctionSpeed) {
        end_in_stop({});
        return;
    }
    // A junction that takes next to nothing is passed as fast as the stretches on both sides allow.
    share.caps = std::max(share.jerk, share.acceleration) >= kNegligible || share.speed < fastest;
    if (share.jerk >= kNegligible) {
        end_length_ = 0;
        add_recent(junction, share.speed);
    }
    builder_.add_junction(share, 0.0F);
}

// Limits used by a junction, `distance` mm back, together with the `earlier` oldest ones.
JunctionShare Planner::share_of(const Junction& junction,
                                std::size_t earlier,
                                float distance,
                                float fastest) const noexcept
{
    JunctionRun run{junction};
    const Blur blur{choice_.deviation, shaper_.mean_time,
                    shaper_.on() ? choice_.deviation / choice_.centripetal : 0.0F};
    JunctionShare share =
        junction_share(run, limits_, end_filter_, kLoneJunctionShare, fastest, blur);
    // Junctions within one window of the axis filters act together.
    const float window = window_of(end_filter_);
    for (std::size_t i = earlier;
         i-- > 0 && junctions_[i].distance - distance < share.speed * window;) {
        run.add(junctions_[i].junction);
        share = junction_share(run, limits_, end_filter_, kDenseJunctionShare, share.speed, blur);
    }
    return share;
}

void Planner::add_recent(const Junction& junction, float speed) noexcept
{
    if (junctions_.full()) {
        // A shaper may hold more of them: none of what they turn is forgotten.
        if (shaper_.on()) {
            junctions_[1].junction.turn += junctions_[0].junction.turn;
        }
        for (std::size_t i = 1; i < junctions_.size(); ++i) {
            junctions_[i - 1] = junctions_[i];
        }
        junctions_.pop_back();
    }
    (void)junctions_.try_push_back({junction, speed, 0.0F});
}

// A stretch is to be added that takes more of the limits than a junction, within one window of the
// axis filters before it, taken into account.
void Planner::apply_junction_limits(const PathDerivatives& coming) noexcept
{
    const float window = window_of(end_filter_);
    for (std::size_t i = junctions_.size(); i-- > 0;) {
        RecentJunction& recent = junctions_[i];
        if (recent.distance >= recent.speed * window) {
            continue;
        }
        if (is_covered_by(recent.junction, coming)) {
            continue;
        }
        recent.junction.second = larger(recent.junction.second, coming.second);
        recent.junction.third = larger(recent.junction.third, coming.third);
        const JunctionShare share = share_of(recent.junction, i, recent.distance, recent.speed);
        recent.speed = share.speed;
        builder_.add_junction(share, recent.distance);
    }
}

// Bounds over the last `distance` mm of the path.
PathDerivatives Planner::bounds_behind(float distance) const noexcept
{
    PathDerivatives bounds{};
    for (const RecentBend& bend : bends_) {
        if (bend.distance < distance) {
            bounds = larger(bounds, bend.derivatives);
        }
    }
    return bounds;
}

// The path has grown by a stretch.
void Planner::age_bounds(const PathDerivatives& passed, float length) noexcept
{
    for (RecentJunction& recent : junctions_) {
        recent.distance += length;
    }
    for (RecentBend& bend : bends_) {
        bend.distance += length;
    }
    if (norm(passed.third) + norm(passed.second) <= 0) {
        return;
    }
    if (bends_.full()) {
        bends_[1].derivatives = larger(bends_[0].derivatives, bends_[1].derivatives);
        for (std::size_t i = 1; i < bends_.size(); ++i) {
            bends_[i - 1] = bends_[i];
        }
        bends_.pop_back();
    }
    (void)bends_.try_push_back({passed, 0.0F});
}

// Overlap in time at the corner at the end of the path so far. None with a shaper, which drains.
CornerOverlap Planner::overlap_at_corner(const EndGeometry& after,
                                         const Block& block) const noexcept
{
    const float deviation =
        std::min(end_left_, kCornerShareOfTolerance * move_.tolerance - move_.departure);
    const Block& last = queue_.block(queue_.block_end() - 1);
    if (deviation <= 0 || shaper_.on() || end_filter_ != block.filter ||
        block.shape == BlockShape::kCurve || block.power != last.power) {
        return {};
    }
    const float length = static_cast<float>(block.length) / kPathUnitsPerMillimetre;
    return corner_overlap(corner_side(last, *end_, end_length_), corner_side(block, after, length),
                          limits_, path_filter_, block.filter, deviation);
}

void Planner::end_in_stop(const CornerOverlap& overlap) noexcept
{
    builder_.stop(overlap);
    junctions_.clear();
    bends_.clear();
    end_.reset();
    end_length_ = 0;
}

}  // namespace cusp::planner
