// Windows: what is planned, what becomes final, and where each plan starts from.
#include "firmware/planner/time_law.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/base/math.hpp"
#include "firmware/base/path_units.hpp"
#include "firmware/planner/law_bounds.hpp"
#include "firmware/planner/law_rows.hpp"
#include "firmware/planner/law_start.hpp"

namespace cusp::planner {
namespace {

constexpr float kFirstMu = 0.1F;
constexpr float kLastMu = 0.001F;
constexpr float kMuRatio = 0.7007F;   // thirteen steps from the first to the last
constexpr float kSpeedWeight = 0.2F;  // of mu, in the last steps
constexpr std::uint8_t kFinalSteps = 3;
constexpr float kFinalSpeedWeight = 0.005F;  // of mu, in these: feeds are reached
constexpr float kTimeHessian = 0.15F;        // in the first steps: x may grow by 1.67 a step
constexpr float kTimeHessianUntil = 2.0F;    // times the last mu
constexpr std::uint32_t kWindow = 40;        // coefficients, but for the last of a stretch
constexpr std::uint8_t kMostSteps = 24;      // of a window, before its last
constexpr float kSettled = 0.003F;           // change by a step of what is as good as it gets
constexpr float kShortestStation = 0.003F;   // s
constexpr float kLongestStation = 0.02F;
constexpr float kCrawlUse = 0.3F;         // greatest use of a limit in the crawl
constexpr float kCrawlOfEnd = 0.5F;       // of the caps at the ends
constexpr float kCrawlOfElement = 0.15F;  // of a stop element's speeds, where it goes on inwards
constexpr std::uint32_t kLeastWindow = 24;
constexpr std::uint32_t kLeastOpen = 16;   // coefficients of a window that do not become final
constexpr float kLeastFinal = 0.04F;       // s, that becomes final, if the window is as long
constexpr std::uint32_t kLeastBehind = 4;  // stations behind a window, for the way from its crawl
constexpr float kEndFromCrawl = 0.4F;      // mm, that the way from a crawl to a stop may take
constexpr float kStillHolds = 0.999999F;   // use of a limit from which a step can start
constexpr float kPartForCrawl = 0.25F;     // of the way left
constexpr float kJerkOfCrawlStop = 0.5F;   // of the least of the axes
constexpr float kBrakingOfCrawl = 0.5F;    // of the least acceleration
constexpr int kMostHalvings = 60;
constexpr float kSlower = 0.6F;  // from one attempt at a crawl to the next
constexpr std::uint8_t kMostFirstAttempts = 40;
constexpr std::uint8_t kMostAttempts = 8;
constexpr std::uint8_t kMostRetreats = 4;
constexpr float kHeavier = 4.0F;  // the barrier after a retreat

// x' = 4/3 x/d at the inner end of an element of length d: the coefficient beyond a cell of length h
// is this times that before it.
float factor_beyond(const StopElement& element, float h) noexcept
{
    const float part = 2.0F * h / (3.0F * element.length);
    return (1.0F - part) / (1.0F + part);
}

std::uint32_t units_of(float mm) noexcept
{
    return static_cast<std::uint32_t>(mm * kPathUnitsPerMillimetre + 0.5F);
}

}  // namespace

void TimeLaw::set_limits(const MachineLimits& limits) noexcept
{
    float longest = 0;
    least_jerk_ = kUnlimited;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        longest = std::max(longest, limits.acceleration[i] / limits.jerk[i]);
        least_jerk_ = std::min(least_jerk_, limits.jerk[i]);
    }
    spline_.ratio = quotient(to_lanes(limits.jerk), to_lanes(limits.acceleration));
    station_time_ = std::clamp(0.25F * longest, kShortestStation, kLongestStation);
    // Its stop reaches the acceleration (v w)^1/2, w the jerk.
    const float of_axes = least(kUnlimited, to_lanes(limits.acceleration));
    const float speed =
        kBrakingOfCrawl * kBrakingOfCrawl * of_axes * of_axes / (kJerkOfCrawlStop * least_jerk_);
    greatest_crawl_ = std::min(crawl_within(kCrawlStop), speed * speed);
    inverse_acceleration_ = quotient(all_lanes(1.0F), to_lanes(limits.acceleration));
    steps_ = 0;
}

void TimeLaw::begin(const StopElement& start) noexcept
{
    window_ = {1, 1, 0.0F, 0.0F};
    start_ = start;
    end_factor_ = 0;
    stations_ = 0;
    planned_ = 0;
    in_force_ = 0;
    final_ = 0;
    ended_ = false;
    rests_ = false;
    extended_ = false;
    attempts_ = 0;
    crawl_ = greatest_crawl_;
    state_ = State::kWaits;
}

void TimeLaw::restrict_crawl(const Station& station) noexcept
{
    crawl_ = std::min(crawl_, kCrawlUse * station.cap);
    KeptShares kept = station.kept;
    kept.always = all_lanes(0.0F);  // whatever the speed
    for (const LaneDerivatives& place : station.places) {
        for (int i = 0; i < kMostHalvings; ++i) {
            const SquaredSpeed x{crawl_, 0.0F, 0.0F};
            const float root = std::sqrt(crawl_);
            const float most = std::max(use(jerk_row(place, kept, x, root)),
                                        use(acceleration_row(place, kept, spline_.ratio, x, root)));
            if (most <= kCrawlUse) {
                break;
            }
            crawl_ *= 0.5F;
        }
    }
}

void TimeLaw::add(const Station& station) noexcept
{
    CUSP_ASSERT(has_room());
    const std::uint32_t k = stations_;
    spline_.station(k) = station;
    // The coefficients k to k + 2 act on the cell.
    if (k == 0) {
        start_factor_ = factor_beyond(start_, station.length);
        // At knot 0 x is the mean of the first two coefficients.
        const float start_cap = 2.0F * start_.cap / (1.0F + start_factor_);
        spline_.cap(0) = station.cap;
        spline_.cap(1) = std::min(station.cap, start_cap);
        crawl_ = std::min(crawl_, kCrawlOfEnd * start_cap);
    } else {
        spline_.cap(k) = std::min(spline_.cap(k), station.cap);
        spline_.cap(k + 1) = std::min(spline_.cap(k + 1), station.cap);
    }
    spline_.cap(k + 2) = station.cap;
    restrict_crawl(station);
    ++stations_;
}

void TimeLaw::end(const StopElement& stop, float overlap, bool disjoint) noexcept
{
    CUSP_ASSERT(stations_ > 0 && !ended_);
    const std::uint32_t n = stations_;
    const float last = spline_.station(n - 1).length;
    spline_.station(n).length = last;
    stop_ = stop;
    overlap_ = overlap;
    disjoint_ = disjoint;
    end_factor_ = factor_beyond(stop, last);
    spline_.cap(n) = std::min(spline_.cap(n), 2.0F * stop.cap / (1.0F + end_factor_));
    ended_ = true;
}

void TimeLaw::work() noexcept
{
    // A window begins with as many stations as find room, so that it does not depend on when they came.
    if (state_ == State::kWaits && !has_room()) {
        begin_window(kLawAdvance);
    }
    if (state_ != State::kWorks) {
        return;
    }
    if (!extended_) {
        extend();
        return;
    }
    if (!begun_) {
        start_near();
        return;
    }
    const bool is_last = mu_ <= last_mu_;
    const float change = newton_step(spline_, window_, weight());
    mu_ = std::max(mu_ * kMuRatio, last_mu_);
    ++steps_;
    ++step_;
    const bool is_settled = step_ >= kMostSteps || (is_last && change < kSettled);
    finishing_ = static_cast<std::uint8_t>(finishing_ + (is_settled || finishing_ > 0 ? 1 : 0));
    if (finishing_ > kFinalSteps) {
        state_ = State::kChecks;
        // Rounding may break a row if the speed changes more than float can tell.
        if (greatest_use(spline_, window_) >= 1.0F) {
            retreat();
        }
    }
}

bool TimeLaw::begin_short_window() noexcept
{
    CUSP_ASSERT(state_ == State::kWaits && !ended_);
    if (stations_ + 1 < window_.begin + kLeastWindow + kLeastBehind) {
        return false;
    }
    begin_window(kLeastBehind);
    return true;
}

void TimeLaw::begin_window(std::uint32_t least_behind) noexcept
{
    const std::uint32_t whole = stations_ + 1;
    window_.end = window_.begin + kWindow;
    if (window_.end < whole || !ended_) {
        make_room_behind(least_behind);
    }
    window_.start_factor = window_.begin == 1 ? start_factor_ : 0.0F;
    if (ended_ && window_.end >= whole) {
        window_.end = whole;
        window_.end_factor = end_factor_;
    }
    extended_ = false;
    begun_ = false;
    attempts_ = 0;
    retreats_ = 0;
    last_mu_ = kLastMu;
    restart();
}

// The path behind a window has room for the way from its crawl to the stop: the window ends
// earlier; or it reaches the end, though it be long, or more of the last plan becomes final.
void TimeLaw::make_room_behind(std::uint32_t least_behind) noexcept
{
    const std::uint32_t whole = stations_ + 1;
    const auto is_narrow = [&](std::uint32_t end) {
        return end + least_behind > whole || length_behind(end) < kEndFromCrawl;
    };
    while (window_.end > window_.begin + kLeastWindow && is_narrow(window_.end)) {
        --window_.end;
    }
    if (!is_narrow(window_.end)) {
        return;
    }
    if (!ended_ || whole >= planned_ + kMostWindow) {
        crawl_ = std::min(crawl_, crawl_within(kPartForCrawl * length_behind(window_.end)));
        return;
    }
    window_.begin = std::max(window_.begin + kMostWindow, whole) - kMostWindow;
    window_.end = whole;
}

// Squared speed from which a stop of two phases takes a distance, mm: v^1.5 j^-1/2.
float TimeLaw::crawl_within(float distance) const noexcept
{
    const float speed = cube_root(distance * distance * least_jerk_);
    return kCrawlOfEnd * speed * speed;
}

// mm from knot k to the stop element at the end.
float TimeLaw::length_behind(std::uint32_t k) const noexcept
{
    float length = 0;
    for (; k < stations_ && length < kEndFromCrawl; ++k) {
        length += spline_.station(k).length;
    }
    return length;
}

// Gives the new coefficients values from which the steps can start: the crawl that the plan ended
// in goes on, slower if it must be, and near the end after the stop element.
void TimeLaw::extend() noexcept
{
    const bool to_the_end = window_.end_factor > 0;
    const std::uint32_t end = window_.end + (to_the_end ? 1 : 2);
    const bool is_first = window_.begin == 1;
    float goal = crawl_;
    float rise = kCrawlOfElement;
    for (int i = 0; i < attempts_; ++i) {
        goal *= is_first || i > 0 ? kSlower : 1.0F;
        rise *= kSlower;
    }
    const std::uint32_t from = std::max<std::uint32_t>(planned_, 1);
    for (std::uint32_t j = planned_; j < end; ++j) {
        spline_.coefficient(j) = goal;
    }
    if (!is_first && attempts_ > 0) {
        ramp(from, window_.end, goal);
    }
    if (to_the_end) {
        // Twice the distance of the coefficient's middle from the end.
        float twice = 2.0F * stop_.length;
        for (std::uint32_t j = stations_; j >= from; --j) {
            twice += spline_.length_before(j);
            const float root = cube_root(0.5F * twice / stop_.length);
            const float most = rise * stop_.cap * (root * root) * (root * root);
            spline_.coefficient(j) = std::min(spline_.coefficient(j), most);
            twice += spline_.length_before(j);
        }
    }
    tie_ends(spline_, window_);
    if (greatest_use(spline_, window_) < kStillHolds) {
        crawl_ = std::min(crawl_, goal);
        planned_ = end;
        extended_ = true;
        for (std::uint32_t j = window_.begin; j < window_.end; ++j) {
            before_[j - window_.begin] = spline_.coefficient(j);
        }
        return;
    }
    ++attempts_;
    if (attempts_ == (is_first ? kMostFirstAttempts : kMostAttempts)) {
        state_ = State::kBlocked;
        if (has_plan()) {
            rest();
        }
    }
}

// Steps start close to the law where that holds; a plan that is refused is made from afar.
void TimeLaw::start_near() noexcept
{
    begun_ = true;
    start_by_ramps(spline_, window_, end_of_kept(spline_, window_, in_force_));
    if (greatest_use(spline_, window_) < kStillHolds) {
        mu_ = last_mu_;
    } else {
        restore();
    }
}

// Coefficients [from, to) go in equal steps from that before them to `goal`.
void TimeLaw::ramp(std::uint32_t from, std::uint32_t to, float goal) noexcept
{
    float value = spline_.coefficient(from - 1);
    for (std::uint32_t j = from; j < to; ++j) {
        value += (goal - value) / static_cast<float>(to - j);
        spline_.coefficient(j) = value;
    }
}

BarrierWeight TimeLaw::weight() const noexcept
{
    const bool is_last = mu_ <= last_mu_;
    const float speed = finishing_ > 0 ? kFinalSpeedWeight : is_last ? kSpeedWeight : 1.0F;
    return {mu_, speed * mu_, mu_ > kTimeHessianUntil * last_mu_ ? kTimeHessian : 1.0F,
            1.0F / station_time_};
}

void TimeLaw::accept(LawPlans& plans) noexcept
{
    CUSP_ASSERT(state_ == State::kChecks || state_ == State::kStays);
    const bool ends = window_.end_factor > 0;
    const std::uint32_t certain = ends ? stations_ : end_of_final();
    if (!has_plan()) {
        LawCell start = cell(0);
        start.travel = units_of(start_.length);
        start.piece = LawPiece::kStart;
        plans.add(start,
                  bounds_of_element(station(0), 0, start.start.value, start_, true, spline_.ratio));
    }
    for (std::uint32_t k = final_; k < open_end(); ++k) {
        const LawCell next = cell(k);
        plans.add(next, bounds_of_cell(station(k), next.start, spline_.ratio));
    }
    if (ends) {
        add_stop(plans);
    } else {
        add_rest(plans);
    }
    if (!plans.publish(certain - final_ + (has_plan() ? 0U : 1U) + (ends ? 1U : 0U))) {
        rest();
        return;
    }
    final_ = certain;
    in_force_ = planned_;
    window_.begin = ends ? window_.begin : certain + 2;
    state_ = ends ? State::kDone : State::kWaits;
}

// Where stations are dense more of them become final: the next window is planned while these are
// played.
std::uint32_t TimeLaw::end_of_final() const noexcept
{
    const std::uint32_t least = window_.begin + kLawAdvance - 2;
    std::uint32_t end = final_;
    for (float time = 0; end < least || (time < kLeastFinal && end + 2 + kLeastOpen < window_.end);
         ++end) {
        const float speed = std::sqrt(spline_.at_start(end).value);
        const float next = std::sqrt(spline_.at_start(end + 1).value);
        time += 2.0F * station(end).length / (speed + next);
    }
    return end;
}

// The element at the end of the stretch.
void TimeLaw::add_stop(LawPlans& plans) const noexcept
{
    const Station& last = station(stations_ - 1);
    LawCell stop = cell(stations_ - 1);
    stop.start = advanced(stop.start, last.length);
    stop.travel = units_of(stop_.length);
    stop.piece = LawPiece::kStop;
    stop.ends = true;
    stop.disjoint = disjoint_;
    stop.overlap = overlap_;
    plans.add(stop, bounds_of_element(last, kPlacesOfCell - 1, stop.start.value, stop_, false,
                                      spline_.ratio));
}

// The way to rest from the crawl.
void TimeLaw::add_rest(LawPlans& plans) const noexcept
{
    for (LawCell cell : stop_from_crawl(planned_)) {
        const Station& last = station(planned_ - 3);
        cell.kind = last.kind;
        cell.percent = last.percent;
        const float length = static_cast<float>(cell.travel) / kPathUnitsPerMillimetre;
        const float time = length / std::sqrt(cell.start.value);
        plans.add(cell, bounds_of_crawl(cell.start.value, time, inverse_acceleration_));
    }
}

void TimeLaw::retreat() noexcept
{
    CUSP_ASSERT(state_ == State::kChecks);
    restore();
    ++retreats_;
    if (retreats_ == kMostRetreats) {
        state_ = State::kStays;
        return;
    }
    last_mu_ *= kHeavier;
    restart();
}

// The coefficients as they were before the window's first step.
void TimeLaw::restore() noexcept
{
    for (std::uint32_t j = window_.begin; j < window_.end; ++j) {
        spline_.coefficient(j) = before_[j - window_.begin];
    }
    tie_ends(spline_, window_);
}

void TimeLaw::rest() noexcept
{
    CUSP_ASSERT(has_plan() && !plans_the_end());
    if (state_ != State::kWaits && extended_) {
        restore();
    }
    rests_ = true;
    state_ = State::kDone;
}

std::int64_t TimeLaw::place_of_rest() const noexcept
{
    const Station& last = station(in_force_ - 3);
    const std::array<LawCell, 2> stop = stop_from_crawl(in_force_);
    return last.begin + last.travel + stop[0].travel + stop[1].travel;
}

void TimeLaw::restart() noexcept
{
    step_ = 0;
    finishing_ = 0;
    mu_ = kFirstMu;
    state_ = State::kWorks;
}

// With jerk w half of the speed is lost in t = (v/w)^1/2, over 5/6 v t, and the rest over 1/6 v t.
std::array<LawCell, 2> TimeLaw::stop_from_crawl(std::uint32_t planned) const noexcept
{
    const float x = spline_.coefficient(planned - 1);
    const float speed = std::sqrt(x);
    const float time = std::sqrt(speed / (kJerkOfCrawlStop * least_jerk_));
    const auto units = [&](float part) {
        return units_of(part * speed * time);
    };
    return {LawCell{{x, 0.0F, 0.0F}, units(5.0F / 6.0F), LawPiece::kBrake},
            LawCell{{0.25F * x, 0.0F, 0.0F}, units(1.0F / 6.0F), LawPiece::kStop}};
}

}  // namespace cusp::planner
