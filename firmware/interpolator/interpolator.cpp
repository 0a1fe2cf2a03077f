// One set point a tick.
#include "firmware/interpolator/interpolator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cusp::interpolator {
namespace {

using planner::LawCell;
using planner::LawPiece;

constexpr unsigned kMostCells = 8;  // that end in a tick
constexpr float kNever = 1e9F;      // s

// Duration of an element, s.
float element_time(const LawCell& cell) noexcept
{
    return 3.0F * static_cast<float>(cell.travel) / kPathUnitsPerMillimetre /
           std::sqrt(cell.start.value);
}

// Bounds of two pieces, whichever is played.
WarpBounds either(const WarpBounds& a, const WarpBounds& b) noexcept
{
    return {larger(a.speed, b.speed),
            smaller(a.braking, b.braking),
            larger(a.speeding, b.speeding),
            smaller(a.falling, b.falling),
            larger(a.rising, b.rising),
            larger(a.joint, b.joint),
            a.time + b.time};
}

// Bounds of two pieces played at once: their sums are within the limits (corner_overlap()). An axis may
// move both ways.
WarpBounds both(const WarpBounds& a, const WarpBounds& b) noexcept
{
    const LaneVec share = all_lanes(planner::kPlanShare);
    const LaneVec acceleration = smaller(larger(magnitude(a.braking), magnitude(a.speeding)) +
                                             larger(magnitude(b.braking), magnitude(b.speeding)),
                                         share);
    const LaneVec jerk = smaller(larger(magnitude(a.falling), magnitude(a.rising)) +
                                     larger(magnitude(b.falling), magnitude(b.rising)),
                                 share);
    return {a.speed + b.speed,
            acceleration * -1.0F,
            acceleration,
            jerk * -1.0F,
            jerk,
            a.joint + b.joint,
            b.time};
}

}  // namespace

Interpolator::Interpolator(planner::Planner& planner) noexcept
    : planner_{planner}, queue_{planner.queue()}, shaper_{planner.shaper()}
{
    leading_ = &tracks_[0];
    trailing_ = &tracks_[1];
    reset({});
}

void Interpolator::reset(Position at) noexcept
{
    for (Track& track : tracks_) {
        track = Track{};
        track.block = queue_.block_begin();
    }
    warp_.set_limits(planner_.limits());
    first_.clear();
    second_.clear();
    shaper_.reset();
    shaper_ticks_ = planner_.shaper().ticks / 2U;
    set_axis_filter(axis_filter_);
    position_ = at;
    along_ = 0;
    power_ = {};
    holding_ = false;
    at_rest_ = true;
    warp_.set_target(1);
    warp_.jump();
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
    return first_.drained() && second_.drained() && shaper_.drained();
}

Position Interpolator::tick() noexcept
{
    along_ = 0;
    const bool is_plain =
        warp_.is_free() && !slowed_ && !holding_ && !braking_ && cell().percent <= 100 && moves();
    const float time = is_plain ? kServoTick : own_time();
    const PathOffset moved = time > 0 ? play(time) : PathOffset{};
    PathOffset smooth = second_.add(first_.add(moved));
    if (shaper_.on()) {
        smooth = shaper_.add(smooth);
    }
    position_.x += axis_division_[0].divide(smooth.x);
    position_.y += axis_division_[1].divide(smooth.y);
    position_.z += axis_division_[2].divide(smooth.z);
    for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
        position_[axis] += axis_division_[axis].divide(smooth[axis]);
    }
    at_rest_ = (!moves() || time <= 0) && filters_drained();
    return position_;
}

// The rate at which a cell is to be played.
float Interpolator::rate_of(const LawCell& cell) const noexcept
{
    const float planned = static_cast<float>(cell.percent) * 0.01F;
    return std::min(overrides_[static_cast<std::size_t>(cell.kind)] / planned, 1.0F);
}

// The own time of the plan that passes in this tick, s, where it may be less than the tick.
float Interpolator::own_time() noexcept
{
    const bool holds = holding_ || braking_;
    if (!moves()) {
        // At rest the first cell counts.
        const LawCell* cell = nullptr;
        const planner::PackedBounds* bounds = nullptr;
        const bool goes_on = queue_.plans().look(0, cell, bounds);
        warp_.set_target(holds || !goes_on ? 0.0F : rate_of(*cell));
        warp_.jump();
        return warp_.rate() * kServoTick;
    }
    if (holds) {
        warp_.set_target(0);
        if (warp_.settled()) {
            return 0;
        }
    }
    look_ahead();
    if (!holds) {
        warp_.set_target(least_rate_);
    }
    return warp_.advance({ahead_.begin(), ahead_.size()});
}

// Collects what is played next, as far as the warp needs it.
void Interpolator::look_ahead() noexcept
{
    ahead_.clear();
    least_rate_ = 1;
    (void)ahead_.try_push_back(before_.unpacked());
    const WarpBounds playing = playing_.unpacked();
    const WarpBounds trailing = trailing_bounds_.unpacked();
    WarpBounds rest_of_cell = playing;
    rest_of_cell.time = cell().piece == LawPiece::kCell
                            ? playing.time * leading_->player.part_left()
                            : leading_->player.time_left();
    const float trails = trailing_->player.stops() ? trailing_->player.time_to_rest() : 0.0F;
    if (cell().piece == LawPiece::kStart && trails <= 0) {
        add_start(rest_of_cell, playing.time);
    } else {
        add_ahead(cell(), trails > 0 ? both(trailing, rest_of_cell) : rest_of_cell);
    }
    float time = rest_of_cell.time;
    const LawCell* next_cell = nullptr;
    const planner::PackedBounds* bounds = nullptr;
    const LawCell* last = &cell();
    WarpBounds bounds_of_last = playing;
    for (std::uint32_t i = 0; time < warp_.reach(); ++i) {
        if (!queue_.plans().look(i, next_cell, bounds)) {
            // At rest nothing hinders.
            WarpBounds rest{};
            rest.time = warp_.reach();
            (void)ahead_.try_push_back(rest);
            return;
        }
        const WarpBounds next = bounds->unpacked();
        if (last->ends && last->overlap > 0) {
            add_ahead(*next_cell, both(bounds_of_last, next));
        }
        add_ahead(*next_cell, time < trails ? both(trailing, next) : next);
        time += next.time;
        last = next_cell;
        bounds_of_last = next;
    }
}

// The rest of an element from rest, in parts: its speed rises by the square of the time, its acceleration
// with the time.
void Interpolator::add_start(const WarpBounds& rest, float whole) noexcept
{
    constexpr float kParts = 4;
    const float passed = whole - rest.time;
    for (float i = 1; i <= kParts; i += 1) {
        const float end = std::min((passed + rest.time * i / kParts) / whole, 1.0F);
        WarpBounds part = rest;
        part.speed = rest.speed * (end * end);
        part.speeding = rest.speeding * end;
        part.time = rest.time / kParts;
        add_ahead(cell(), part);
    }
}

void Interpolator::add_ahead(const LawCell& cell, const WarpBounds& bounds) noexcept
{
    least_rate_ = std::min(least_rate_, rate_of(cell));
    // The rest of the piece that is played stays apart: with the next it would seem to need more than either does.
    constexpr std::size_t kPlayed = 2;
    const bool is_short = ahead_.size() > kPlayed && ahead_.back().time < kServoTick;
    if (is_short || ahead_.full()) {
        ahead_.back() = either(ahead_.back(), bounds);
    } else {
        (void)ahead_.try_push_back(bounds);
    }
}

// Plays the plan for a time of its own.
PathOffset Interpolator::play(float time) noexcept
{
    PathOffset moved{};
    if (!trailing_->player.needs_cell()) {
        float left = time;
        moved = travel(*trailing_, trailing_->player.advance(left));
    }
    float left = time;
    for (unsigned i = 0; i < kMostCells && left > 0; ++i) {
        if (leading_->player.needs_cell() && !begin_next()) {
            break;
        }
        const float wait = cell().ends ? time_to_next() : kNever;
        if (wait < left) {
            float rest = left;
            moved = moved + travel(*leading_, leading_->player.advance(rest));
            left -= wait;
            change_track();
            continue;
        }
        moved = moved + travel(*leading_, leading_->player.advance(left));
    }
    if (passed_) {
        passed_ = false;
        drop_passed_blocks();
    }
    return moved;
}

// The leading track's next cell, if there is one. One that starts from rest waits for the filters where
// the block has others, and for the stretch before.
bool Interpolator::begin_next() noexcept
{
    const LawCell* next = nullptr;
    const planner::PackedBounds* bounds = nullptr;
    if (!queue_.plans().look(0, next, bounds)) {
        return false;
    }
    const bool waits = next->piece == LawPiece::kStart && leading_->offset == 0 &&
                       !(trailing_->player.needs_cell() && takes_filter_of(leading_->block));
    if (!waits) {
        begin_cell(*next, *bounds);
    }
    return !waits;
}

// The cell that look(0) gives is played.
void Interpolator::begin_cell(const LawCell& next, const planner::PackedBounds& bounds) noexcept
{
    before_ = playing_;
    playing_ = bounds;
    if (next.piece == LawPiece::kStart) {
        before_ = planner::PackedBounds{};
        leading_->at_stop = false;
    }
    leading_->player.play(next);
    queue_.plans().pass();
}

// Own time until the next stretch may begin, while this one is not yet at its end, s.
float Interpolator::time_to_next() noexcept
{
    if (leading_->player.needs_cell() || !trailing_->player.needs_cell() ||
        !leading_->player.stops()) {
        return kNever;
    }
    const LawCell* start = nullptr;
    const planner::PackedBounds* bounds = nullptr;
    std::uint32_t block = 0;
    if (!queue_.plans().look(0, start, bounds) || !find_next(block) || !takes_filter_of(block)) {
        return kNever;
    }
    const float overlap =
        cell().disjoint ? cell().overlap : std::min(cell().overlap, element_time(*start));
    return std::max(leading_->player.time_to_rest() - overlap, 0.0F);
}

// The other track takes the stretch after the one that still goes on.
void Interpolator::change_track() noexcept
{
    std::uint32_t next = 0;
    (void)find_next(next);
    if (!leading_->player.needs_cell()) {
        std::swap(leading_, trailing_);
        trailing_bounds_ = playing_;
    }
    passed_ = true;
    leading_->player = LawPlayer{};
    leading_->block = next;
    leading_->offset = 0;
    leading_->place = {};
    const LawCell* first = nullptr;
    const planner::PackedBounds* bounds = nullptr;
    if (queue_.plans().look(0, first, bounds)) {
        begin_cell(*first, *bounds);
    }
}

// True if the axis filters are those of a block, or can be changed to them. A shaper reaches too far
// for anything to begin before it is drained: what it holds is on the path before the stop.
bool Interpolator::takes_filter_of(std::uint32_t block) noexcept
{
    if (block == queue_.block_end()) {
        return false;
    }
    const planner::AxisFilter wanted = queue_.block(block).filter;
    if (wanted == axis_filter_ && !shaper_.on()) {
        return true;
    }
    if (moves() || !filters_drained()) {
        return false;
    }
    set_axis_filter(wanted);
    return true;
}

// The first block of the stretch after the one that the leading track is on. False where too many
// come before it.
bool Interpolator::find_next(std::uint32_t& block) const noexcept
{
    constexpr std::uint32_t kBlocksToLookAt = 16;
    block = leading_->block;
    bool found = leading_->at_stop;
    for (std::uint32_t i = 0; i < kBlocksToLookAt && !found; ++i) {
        found = block != queue_.block_end() && queue_.block(block).stops;
        ++block;
    }
    return found;
}

// Moves a track on along its blocks. Returns by how much, per axis, path units.
[[gnu::always_inline]] inline PathOffset Interpolator::travel(Track& track,
                                                              std::uint32_t along) noexcept
{
    along_ += static_cast<std::int32_t>(along);
    if (along == 0) {
        return {};
    }
    const std::uint32_t offset = track.offset + along;
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
    passed_ = true;
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
            track.at_stop = true;
            break;
        }
    }
    track.offset = offset;
    track.place = place;
    return place - before;
}

// After a track has passed a block, or is at its end.
void Interpolator::drop_passed_blocks() noexcept
{
    const Track& last = trailing_->player.needs_cell() ? *leading_ : *trailing_;
    while (queue_.block_begin() != last.block) {
        queue_.drop_block();
    }
}

void Interpolator::set_feed_override(unsigned percent) noexcept
{
    overrides_[static_cast<std::size_t>(path::MoveKind::kFeed)] =
        static_cast<float>(percent) * 0.01F;
    planner_.set_feed_override(percent);
    slowed_ = overrides_[0] < 1 || overrides_[1] < 1;
}

void Interpolator::set_rapid_override(unsigned percent) noexcept
{
    overrides_[static_cast<std::size_t>(path::MoveKind::kRapid)] =
        static_cast<float>(percent) * 0.01F;
    slowed_ = overrides_[0] < 1 || overrides_[1] < 1;
}

float Interpolator::speed() const noexcept
{
    return static_cast<float>(along_) / kPathUnitsPerTick;
}

}  // namespace cusp::interpolator
