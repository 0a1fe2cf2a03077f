// Blocks in, plans out: one step of the law a call.
#include "firmware/planner/stretch_planner.hpp"

#include <algorithm>

#include "firmware/planner/corner_overlap.hpp"
#include "firmware/planner/law_check.hpp"

namespace cusp::planner {
namespace {

constexpr unsigned kStationsACall = 4;
constexpr float kMostUse = 1.0005F;  // of the limits, by the check

}  // namespace

void StretchPlanner::set_limits(const MachineLimits& limits) noexcept
{
    limits_ = limits;
    limits_.acceleration = limits.acceleration * kPlanShare;
    limits_.jerk = limits.jerk * kPlanShare;
    law_.set_limits(limits_);
    spacing_.set_limits(limits_, law_.station_time());
    reset();
}

void StretchPlanner::reset() noexcept
{
    path_.clear();
    next_ = queue_.block_end();
    stage_ = Stage::kIdle;
    start_ = full_stop(limits_);
}

void StretchPlanner::set_percent(unsigned percent) noexcept { percent_ = std::max(percent, 100U); }

StopChoice StretchPlanner::choice_at(const Block& block) const noexcept
{
    const float overlap = static_cast<float>(block.overlap) * kOverlapUnit;
    const float share = static_cast<float>(block.share) / kWholeShare;
    return block.share < kWholeShare ? StopChoice{overlap + kServoTick, share} : full_stop(limits_);
}

void StretchPlanner::begin_stretch() noexcept
{
    path_.clear();
    checked_ = {};
    spacing_.begin(start_, {}, 0);
    ended_ = false;
    stage_ = Stage::kBegins;
}

void StretchPlanner::close(const Block& last) noexcept
{
    stop_ = choice_at(last);
    overlap_ = static_cast<float>(last.overlap) * kOverlapUnit;
    disjoint_ = last.disjoint;
    spacing_.set_stop(stop_);
    path_.close();
}

// The blocks up to the next stop.
bool StretchPlanner::read_blocks() noexcept
{
    bool read = false;
    // The last may have become one that stops.
    if (!path_.closed() && path_.end() > 0 && queue_.block(next_ - 1).stops) {
        close(queue_.block(next_ - 1));
        return true;
    }
    while (!path_.closed() && !path_.full() && next_ != queue_.block_end()) {
        Block& block = queue_.block(next_);
        if (block.kind == path::MoveKind::kFeed) {
            const float factor = static_cast<float>(percent_) * 0.01F;
            block.percent = static_cast<std::uint8_t>(percent_);
            block.feed *= factor * factor;
        }
        path_.append(block);
        ++next_;
        read = true;
        if (block.stops) {
            close(block);
        }
    }
    return read;
}

bool StretchPlanner::add_stations() noexcept
{
    StopElement element;
    if (stage_ == Stage::kBegins) {
        if (!spacing_.start(element)) {
            return false;
        }
        law_.begin(element);
        stage_ = Stage::kRuns;
    }
    unsigned added = 0;
    Station station;
    while (added < kStationsACall && !ended_ && law_.has_room() && spacing_.next(station)) {
        law_.add(station);
        ++added;
        if (spacing_.finished()) {
            law_.end(spacing_.stop(), overlap_, disjoint_);
            ended_ = true;
        }
    }
    return added > 0;
}

// The window that is planned, if one is.
bool StretchPlanner::judge() noexcept
{
    using State = TimeLaw::State;
    LawPlans& plans = queue_.plans();
    if (plans.room() < law_.plan_cells()) {
        return false;
    }
    const std::int64_t begin = law_.station(law_.first_cell()).begin;
    if (law_.state() == State::kChecks) {
        const float use = greatest_use(law_, path_, checked_, limits_);
        path_.seek(checked_, begin);
        if (use > kMostUse) {
            law_.retreat();
            return true;
        }
    }
    law_.accept(plans);
    // The tick passes blocks before the next window from now on.
    path_.seek(checked_, law_.station(law_.first_cell()).begin);
    path_.drop_before(checked_);
    return true;
}

void StretchPlanner::go_on_from_rest() noexcept
{
    const std::int64_t rest = law_.place_of_rest();
    PathCursor cursor = checked_;
    path_.seek(cursor, rest);
    checked_ = cursor;
    path_.drop_before(checked_);
    spacing_.begin(full_stop(limits_), cursor, rest);
    ended_ = false;
    stage_ = Stage::kBegins;
}

// More blocks find room only when some are passed: the law goes on with what it has, or the path stops
// at the end of the last.
void StretchPlanner::begin_with_full_ring() noexcept
{
    if (!law_.begin_short_window()) {
        queue_.block(next_ - 1).stops = true;
    }
}

bool StretchPlanner::work() noexcept
{
    using State = TimeLaw::State;
    if (stage_ == Stage::kIdle) {
        if (next_ == queue_.block_end()) {
            return false;
        }
        begin_stretch();
    }
    const bool read = read_blocks();
    const bool added = add_stations();
    if (stage_ != Stage::kRuns) {
        return read;
    }
    if (law_.has_plan() && !law_.plans_the_end() && queue_.plans().starves()) {
        law_.rest();
    }
    const State before = law_.state();
    bool worked = added;
    if (before == State::kChecks || before == State::kStays) {
        worked = judge() || worked;
    } else if (!added) {
        law_.work();
        worked = before == State::kWorks || law_.state() != before;
    }
    if (!added && law_.state() == State::kWaits && before == State::kWaits && !ended_ &&
        path_.full()) {
        begin_with_full_ring();
        return true;
    }
    if (law_.rests()) {
        go_on_from_rest();
        return true;
    }
    if (law_.state() == State::kDone) {
        start_ = stop_;
        stage_ = Stage::kIdle;
        return true;
    }
    return worked || read;
}

}  // namespace cusp::planner
