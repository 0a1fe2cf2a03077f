// Expected speeds of spans, and cells cut from them.
#include "firmware/planner/station_spacing.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

constexpr float kExpectedCentripetal = 0.9F;  // of the acceleration
constexpr float kExpectedJerk = 0.7F;         // of the jerk, by the path's third derivative
constexpr float kLeastBraking = 0.15F;        // of the acceleration that a bend leaves
constexpr float kGrowth = 0.25F;              // of a cell beside its neighbour
constexpr float kFineGrowth = 0.5F;           // where cells are short
constexpr float kFineCell = 0.002F;           // mm
constexpr float kFirstCell = 0.55F;           // of the stop element's length
constexpr float kShortestSpan = 0.002F;       // s
constexpr float kLongestSpan = 0.02F;         // s
constexpr float kLeastCell = 2e-6F;           // mm
constexpr float kMarkedJump = 0.02F;          // of the acceleration
constexpr float kMarkedChange = 0.05F;        // of the jerk
constexpr float kNearMark = 0.3F;             // of a cell: a mark so close is none
constexpr float kEvenCells = 3.3F;            // cells up to a mark that are of one length
constexpr float kMostElement = 1.0F / 12.0F;  // of the stretch
constexpr float kJointWindow = 0.06F;         // s, no shorter than the reach of a joint
constexpr float kReachOfChoice = 5.0F;        // cells
// mm, that elements take, and a plan to stop
constexpr float kKnownBehind = 2.0F * kLongestElement + 0.3F;

// Growth of the cell beside one of length h. At the shortest elements the law is far below its limits.
float growth_of(float h) noexcept { return h < kFineCell ? kFineGrowth : kGrowth; }

// The squared speed that jerk allows s mm from rest, where it is below x.
float least_by_jerk(float x, float jerk, float s) noexcept
{
    constexpr float kClearlyAbove = 1.0001F;  // far more than rounding takes: no root is needed
    const float cube = std::min(4.5F * jerk * s * s, 1e15F);
    if (cube > kClearlyAbove * x * std::sqrt(x)) {
        return x;
    }
    const float speed = cube_root(cube);
    return std::min(x, speed * speed);
}

}  // namespace

void StationSpacing::set_limits(const MachineLimits& limits, float station_time) noexcept
{
    limits_ = limits;
    station_time_ = station_time;
    maker_.set_limits(limits);
    longest_ = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        longest_ = std::max(longest_, limits.acceleration[i] / limits.jerk[i]);
    }
}

void StationSpacing::begin(const StopChoice& start,
                           const PathCursor& cursor,
                           std::int64_t place) noexcept
{
    start_choice_ = start;
    span_begin_ = 0;
    span_end_ = 0;
    joints_.clear();
    collected_ = cursor;
    turns_.clear();
    read_ = cursor;
    read_stretch_ = 0;
    read_offset_ = static_cast<std::uint32_t>(place - cursor.begin);
    cursor_ = cursor;
    at_ = place;
    rest_ = place;
    last_ = 0;
    mark_next_ = false;
    entry_ = kUnlimited;
    started_ = false;
    stop_settled_ = false;
    finished_ = false;
}

void StationSpacing::set_stop(const StopChoice& stop) noexcept { stop_choice_ = stop; }

// Reads the path into spans as far as there is room.
void StationSpacing::read_spans() noexcept
{
    bool read = false;
    while (read_one()) {
        read = true;
    }
    if (read) {
        pass_backward();
    }
}

// Reads one stretch of a block, or its joint with the next. False: there is none, or no room.
bool StationSpacing::read_one() noexcept
{
    if (read_.block == path_.end() || span_end_ - span_begin_ == kSpans) {
        return false;
    }
    const LawBlock law_block = path_[read_.block];
    const Block& block = *law_block.block;
    if (read_stretch_ != stretch_count(block)) {
        StretchReader reader{block, read_stretch_};
        const Stretch stretch = reader.next();
        ++read_stretch_;
        if (stretch.end > read_offset_) {
            add_span(stretch, read_to(), law_block);
            read_offset_ = stretch.end;
        }
        return true;
    }
    if (read_.block + 1 != path_.end()) {
        read_joint(read_);
    } else if (!path_.closed()) {
        return false;  // its joint with the next is not known
    }
    read_.begin += block.length;
    ++read_.block;
    read_stretch_ = 0;
    read_offset_ = 0;
    return true;
}

void StationSpacing::read_joint(const PathCursor& before) noexcept
{
    const ReadJoint joint = maker_.joint(path_, before);
    const LawBlock last = path_[before.block];
    const LawBlock next = path_[before.block + 1];
    const float speed = std::min(span(span_end_ - 1).cap, next.feed);
    const float root = std::sqrt(speed);
    const float jerk = greatest(0.0F, joint.always + magnitude(joint.jump) * speed);
    const float change = greatest(0.0F, joint.change * (speed * root));
    entry_ = std::min(entry_, 1.0F / greatest(kTinyBound, magnitude(joint.jump)));
    mark_next_ = mark_next_ || std::fabs(last.feed - next.feed) > 1e-3F * last.feed ||
                 jerk * joint.window > kMarkedJump * longest_ || change > kMarkedChange;
    if (joint.turned >= kNegligibleTurn) {
        add_turn(joint.at, joint.turned, root * joint.window);
        const float second = static_cast<float>(last.block->filter.second) * kServoTick;
        const float through = speed_through(joint, root, second);
        entry_ = std::min(entry_, through * through);
    }
}

void StationSpacing::add_span(const Stretch& stretch,
                              std::int64_t begin,
                              const LawBlock& block) noexcept
{
    const LaneDerivatives& q = stretch.derivatives;
    const LaneVec tiny = all_lanes(kTinyBound);
    const LaneVec along = larger(q.first, tiny);
    const LaneVec acceleration = to_lanes(limits_.acceleration);
    const LaneVec ratio = quotient(to_lanes(limits_.velocity), along);
    float cap = least(block.feed, product(ratio, ratio));
    cap = least(cap, quotient(acceleration * kExpectedCentripetal, larger(q.second, tiny)));
    const float bend = norm(q.second);
    cap = std::min(cap, block.centripetal / std::max(bend, kTinyBound));
    const float cube =
        least(1e15F, quotient(to_lanes(limits_.jerk) * kExpectedJerk, larger(q.third, tiny)));
    const float by_jerk = cube_root(std::max(cube, 1e-9F));
    cap = std::min(cap, by_jerk * by_jerk);
    const LaneVec left = larger(acceleration - q.second * cap, acceleration * kLeastBraking);
    const float brake = least(kUnlimited, quotient(left, along));
    const float length = static_cast<float>(stretch.end - read_offset_) / kPathUnitsPerMillimetre;
    const bool is_mark = mark_next_;
    const float entry = entry_;
    mark_next_ = false;
    entry_ = kUnlimited;
    if (span_end_ != span_begin_ && !is_mark) {
        PathSpan& last = span(span_end_ - 1);
        const float whole = last.length + length;
        const bool alike = std::fabs(cap - last.cap) < 0.03F * cap;
        const float most =
            std::sqrt(std::min(cap, last.cap)) * (alike ? kLongestSpan : kShortestSpan);
        if (whole < most) {
            last.length = whole;
            last.cap = std::min({last.cap, cap, entry});
            last.brake = std::min(last.brake, brake);
            last.forward = std::min(last.forward, last.cap);
            return;
        }
    }
    float forward = 0;
    if (span_end_ != span_begin_) {
        const PathSpan& last = span(span_end_ - 1);
        forward = std::min(std::min(last.cap, cap), last.forward + 2.0F * last.brake * last.length);
        forward = std::min(forward, entry);
    }
    span(span_end_) = {begin, length, cap, brake, forward, forward, is_mark, true};
    ++span_end_;
}

// True if what is read next may be added to the last span, and lower it.
bool StationSpacing::may_grow() const noexcept
{
    const PathSpan& last = span(span_end_ - 1);
    return !knows_all() && last.length < std::sqrt(last.cap) * kLongestSpan;
}

// From the end of the known path, where the tool rests, back to the first span that this changes.
void StationSpacing::pass_backward() noexcept
{
    float after = 0;
    bool tentative = !knows_all();
    for (std::uint32_t i = span_end_; i-- != span_begin_;) {
        PathSpan& own = span(i);
        const bool may_fall = i + 1 == span_end_ && may_grow();
        const float back = may_fall ? 0.0F : after + 2.0F * own.brake * own.length;
        own.expected = std::min(own.forward, back);
        tentative = tentative && back < own.forward;
        own.is_tentative = tentative;
        after = own.expected;
    }
}

// Squared speed expected at a place.
float StationSpacing::expected_at(std::int64_t at) const noexcept
{
    std::uint32_t i = span_begin_;
    while (i + 1 != span_end_ && span(i + 1).begin <= at) {
        ++i;
    }
    const PathSpan& own = span(i);
    const float within = std::max(distance(own.begin, at), 0.0F);
    const float after = i + 1 == span_end_ ? 0.0F : span(i + 1).expected;
    float x = std::min(own.cap, own.expected + 2.0F * own.brake * within);
    x = std::min(x, after + 2.0F * own.brake * std::max(own.length - within, 0.0F));
    // From and to rest by jerk.
    x = least_by_jerk(x, start_jerk_, std::max(distance(rest_, at), start_.length));
    if (stop_settled_) {
        const float to = std::max(distance(at, path_.length()), stop_.length);
        // Farther off the stop may not be known yet.
        const float known = std::sqrt(x) * kJointWindow + kKnownBehind;
        x = to < known ? least_by_jerk(x, stop_jerk_, to) : x;
    }
    return x;
}

// Length of a cell at a place, by its time.
float StationSpacing::wanted_at(std::int64_t at) const noexcept
{
    return std::max(station_time_ * std::sqrt(expected_at(at)), kLeastCell);
}

bool StationSpacing::knows_enough() const noexcept
{
    return started_ ? knows_next() : knows_start();
}

// True if the speeds around the next cell do not depend on what is not yet known.
bool StationSpacing::knows_next() const noexcept
{
    if (knows_all() || span_end_ - span_begin_ == kSpans) {
        return true;
    }
    const float wanted = wanted_at(at_);
    const float speed = std::sqrt(std::max(expected_at(at_), expected_at(at_ + to_units(wanted))));
    const float reach = kReachOfChoice * std::max(wanted, station_time_ * speed) +
                        reach_of_joints(speed) + kKnownBehind;
    std::uint32_t i = span_begin_;
    while (i != span_end_ && !span(i).is_tentative && distance(at_, span(i).begin) < reach) {
        ++i;
    }
    return i != span_end_ && !span(i).is_tentative;
}

// True if the element that the stretch starts with does not.
bool StationSpacing::knows_start() const noexcept
{
    return knows_all() || span_end_ - span_begin_ == kSpans ||
           distance(rest_, read_to()) * kMostElement >= kLongestElement;
}

bool StationSpacing::knows_all() const noexcept
{
    return path_.closed() && read_.block == path_.end();
}

// Along the path, of an element that uses all that it may.
float jerk_of(const StopElement& element) noexcept
{
    const float speed = std::sqrt(element.cap);
    return speed * speed * speed / (4.5F * element.length * element.length);
}

void StationSpacing::settle_stop() noexcept
{
    PathCursor cursor = cursor_;
    path_.seek(cursor, path_.length(), true);
    const float most = distance(rest_, path_.length()) * kMostElement;
    stop_ = maker_.element(path_, cursor, path_.length(), true, stop_choice_, most);
    stop_jerk_ = jerk_of(stop_);
    inner_end_ = path_.length() - to_units(stop_.length);
    stop_settled_ = true;
}

bool StationSpacing::start(StopElement& element) noexcept
{
    CUSP_ASSERT(!started_);
    read_spans();
    if (read_to() == rest_ || (!knows_start() && !path_.full())) {
        return false;
    }
    const float known = distance(rest_, read_to()) * kMostElement;
    start_ = maker_.element(path_, cursor_, rest_, false, start_choice_, known);
    start_jerk_ = jerk_of(start_);
    element = start_;
    at_ = rest_ + to_units(start_.length);
    path_.seek(cursor_, at_);
    started_ = true;
    return true;
}

// Where the cell from `at_` on ends.
std::int64_t StationSpacing::choose_end() const noexcept
{
    float h = wanted_at(at_);
    h = std::min(h, last_ > 0 ? (1.0F + growth_of(last_)) * last_ : kFirstCell * start_.length);
    for (const float ahead : {0.5F, 1.0F, 1.5F, 2.0F, 3.0F}) {
        const float s = ahead * h;
        h = std::min(h, wanted_at(at_ + to_units(s)) + kGrowth * s);
    }
    std::int64_t mark = at_ + (std::int64_t{1} << 40);
    if (stop_settled_) {
        mark = inner_end_;
        const float left = std::max(distance(at_, mark), 0.0F);
        const float growth = growth_of(left);
        h = std::min(h, (kFirstCell * stop_.length + growth * left) / (1.0F + growth));
    }
    const std::int64_t near = at_ + to_units(kNearMark * h);
    for (std::uint32_t i = span_begin_; i != span_end_ && span(i).begin < mark; ++i) {
        const std::int64_t behind = mark - span(i).begin;
        if (span(i).is_mark && span(i).begin > near && behind > to_units(kNearMark * h)) {
            mark = span(i).begin;
        }
    }
    const float left = distance(at_, mark);
    if (left < kEvenCells * h) {
        const int cells = 1 + static_cast<int>(0.999F * left / h);
        if (cells == 1) {
            return mark;
        }
        h = left / static_cast<float>(cells);
    }
    return at_ + std::max<std::int64_t>(to_units(h), 1);
}

bool StationSpacing::next(Station& station) noexcept
{
    CUSP_ASSERT(started_);
    if (finished_) {
        return false;
    }
    while (span_end_ - span_begin_ > 1 && span(span_begin_ + 1).begin <= at_) {
        ++span_begin_;
    }
    read_spans();
    if (knows_all() && !stop_settled_) {
        pass_backward();
        settle_stop();
    }
    if (!knows_next()) {
        return false;
    }
    const std::int64_t to = choose_end();
    const float speed = std::sqrt(std::max(expected_at(at_), expected_at(to)));
    collect_joints(to + to_units(reach_of_joints(speed) + distance(at_, to)));
    station = maker_.make(path_, cursor_, at_, to, {joints_.begin(), joints_.size()}, speed);
    last_ = station.length;
    at_ = to;
    drop_joints();
    finished_ = stop_settled_ && at_ >= inner_end_;
    if (finished_) {
        station.acceleration_at_end = true;
    } else {
        path_.seek(cursor_, at_);
    }
    return true;
}

}  // namespace cusp::planner
