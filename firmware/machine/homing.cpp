// The phases of homing.
#include "firmware/machine/homing.hpp"

#include <algorithm>

#include "firmware/machine/report_units.hpp"

namespace cusp::machine {
namespace {

// Distances of search, as in Grbl: over the travel, a turn where it has no end, and over the pull-off.
constexpr float kSeekOverTravel = 1.5F;
constexpr float kTurn = 360.0F;
constexpr float kLocateOverPullOff = 5.0F;

std::int64_t nanometres(float mm) noexcept { return to_nanometres(static_cast<double>(mm)); }

// By how much one switch of a squared axis may close later than the other, mm. As in grblHAL.
float most_skew(const Settings& settings, unsigned axis) noexcept
{
    constexpr float kPercent = 0.01F;
    const float part =
        kPercent * settings.value(Setting::kSquarePercent) * settings.value(Setting::kTravel, axis);
    return std::max(std::min(part, settings.value(Setting::kSquareMost)),
                    settings.value(Setting::kSquareLeast));
}

}  // namespace

void Homing::begin(AxisMask axes, const Settings& settings) noexcept
{
    axes_ = axes;
    alarm_ = Alarm::kNone;
    moving_ = false;
    resting_ = false;
    (void)next_axis(settings);
}

bool Homing::homes_to_minus(const Settings& settings) const noexcept
{
    return (settings.whole(Setting::kHomingDirection) >> axis_ & 1U) != 0;
}

// Pass by pass, X first in each; then those that no pass names.
bool Homing::next_axis(const Settings& settings) noexcept
{
    for (unsigned pass = 0; pass <= kHomingPasses; ++pass) {
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            const bool named = pass == kHomingPasses || settings.homing_pass(pass).contains(axis);
            if (named && axes_.contains(axis)) {
                axis_ = axis;
                axes_.bits = static_cast<std::uint8_t>(axes_.bits & ~(1U << axis));
                phase_ = Phase::kSeek;
                return true;
            }
        }
    }
    return false;
}

auto Homing::step(Motion& motion, const Settings& settings) noexcept -> Progress
{
    if (resting_) {
        if (static_cast<std::int32_t>(motion.ticks() - rest_until_) < 0) {
            return Progress::kWaiting;
        }
        resting_ = false;
        return finish_phase(motion, settings);
    }
    if (!moving_) {
        if (!motion.settled() || !motion.has_room()) {
            return Progress::kWaiting;
        }
        return start_phase(motion, settings);
    }
    const bool stopped = motion.contact() ? motion.at_rest() : motion.settled();
    if (!stopped) {
        return Progress::kWaiting;
    }
    if (motion.contact()) {
        note_contact(motion);
    }
    motion.abandon();
    moving_ = false;
    // Switches bounce: the debounce time passes before the next reading.
    resting_ = true;
    rest_until_ = motion.ticks() + settings.whole(Setting::kHomingDebounce);
    return Progress::kStepped;
}

// The switches of the axis, or that of the motor that is squared.
std::uint16_t Homing::switches(const Settings& settings) const noexcept
{
    const unsigned first = limit_input(axis_);
    if (phase_ == Phase::kSquare) {
        return static_cast<std::uint16_t>(lagging_ == Motors::kFirst ? first
                                                                     : unsigned{kFourthLimit});
    }
    return static_cast<std::uint16_t>(settings.squares(axis_) ? first | kFourthLimit : first);
}

void Homing::note_contact(const Motion& motion) noexcept
{
    if (phase_ == Phase::kSquare) {
        later_contact_ = (*motion.contact())[axis_];
        return;
    }
    contact_ = (*motion.contact())[axis_];
    const bool first = (motion.contact_inputs() & limit_input(axis_)) != 0;
    lagging_ = first ? Motors::kFourth : Motors::kFirst;
    later_contact_.reset();
    const bool both = first && (motion.contact_inputs() & kFourthLimit) != 0;
    if (both) {
        later_contact_ = contact_;
    } else if (const std::optional<Position> later = motion.later_contact()) {
        later_contact_ = (*later)[axis_];
    }
    other_at_ = motion.position()[axis_];
}

auto Homing::start_phase(Motion& motion, const Settings& settings) noexcept -> Progress
{
    const std::int64_t at = motion.tail()[axis_];
    motion.drive(phase_ == Phase::kSquare || phase_ == Phase::kAlign ? lagging_ : Motors::kBoth);
    motion.watch({});
    switch (phase_) {
        case Phase::kSeek:
        case Phase::kLocate:
        case Phase::kSquare:
            if (!start_search(motion, settings)) {
                return fail(Alarm::kSquaringApproach);
            }
            break;
        case Phase::kAlign:
            go(motion, alignment(motion, settings), settings.value(Setting::kHomingFeed));
            break;
        case Phase::kFirstPullOff:
        case Phase::kSecondPullOff: {
            const std::int64_t sign = homes_to_minus(settings) ? -1 : 1;
            const float pull_off = settings.pull_off(axis_);
            go(motion, contact_ - sign * nanometres(pull_off) - at,
               settings.value(Setting::kHomingSeek));
            break;
        }
    }
    moving_ = true;
    return Progress::kStepped;
}

// False where the lagging motor is too far behind.
bool Homing::start_search(Motion& motion, const Settings& settings) noexcept
{
    const std::int64_t sign = homes_to_minus(settings) ? -1 : 1;
    const float travel = settings.has_ends(axis_) ? settings.value(Setting::kTravel, axis_) : kTurn;
    std::int64_t distance = nanometres(kSeekOverTravel * travel);
    if (phase_ == Phase::kLocate) {
        distance = nanometres(kLocateOverPullOff * settings.pull_off(axis_));
    } else if (phase_ == Phase::kSquare) {
        distance = nanometres(most_skew(settings, axis_)) - sign * (other_at_ - contact_);
    }
    if (distance <= 0) {
        return false;
    }
    motion.watch({switches(settings), false, true});
    go(motion, sign * distance,
       settings.value(phase_ == Phase::kSeek ? Setting::kHomingSeek : Setting::kHomingFeed));
    return true;
}

// Travel of the lagging motor until it is as far beyond its switch as the other one.
std::int64_t Homing::alignment(const Motion& motion, const Settings& settings) const noexcept
{
    const std::int64_t offset = nanometres(settings.value(Setting::kSquareOffset, axis_));
    return later_contact_.value_or(other_at_) + other_at_ - contact_ +
           (lagging_ == Motors::kFourth ? offset : -offset) - motion.tail()[axis_];
}

void Homing::go(Motion& motion, std::int64_t distance, float mm_per_minute) const noexcept
{
    path::Move move;
    move.kind = path::MoveKind::kFixedFeed;
    move.start = motion.tail();
    move.end = move.start;
    move.end[axis_] += distance;
    move.feed = mm_per_minute / kSecondsPerMinute;
    motion.push(move);
    motion.close();
}

auto Homing::finish_search(const Motion& motion, const Settings& settings) noexcept -> Progress
{
    if (!motion.contact()) {
        return fail(phase_ == Phase::kSquare ? Alarm::kSquaringApproach : Alarm::kHomingApproach);
    }
    if (phase_ == Phase::kSeek) {
        phase_ = Phase::kFirstPullOff;
    } else if (!settings.squares(axis_)) {
        phase_ = Phase::kSecondPullOff;
    } else {
        // A switch that closes while the axis stops may be seen after the watch has ended.
        const unsigned later =
            lagging_ == Motors::kFirst ? unsigned{limit_input(axis_)} : unsigned{kFourthLimit};
        const bool known = later_contact_.has_value() || closed(motion, later);
        phase_ = known ? Phase::kAlign : Phase::kSquare;
    }
    return Progress::kStepped;
}

auto Homing::finish_phase(Motion& motion, const Settings& settings) noexcept -> Progress
{
    switch (phase_) {
        case Phase::kSeek:
        case Phase::kLocate:
        case Phase::kSquare:
            return finish_search(motion, settings);
        case Phase::kAlign: {
            Position at = motion.position();
            at[axis_] = other_at_;
            motion.relocate(at);
            phase_ = Phase::kSecondPullOff;
            return Progress::kStepped;
        }
        case Phase::kFirstPullOff:
        case Phase::kSecondPullOff:
            break;
    }
    if (closed(motion, switches(settings))) {
        return fail(Alarm::kHomingPullOff);
    }
    if (phase_ == Phase::kFirstPullOff) {
        phase_ = Phase::kLocate;
        return Progress::kStepped;
    }
    return finish_axis(motion, settings);
}

auto Homing::finish_axis(Motion& motion, const Settings& settings) noexcept -> Progress
{
    const std::int64_t pull_off = nanometres(settings.pull_off(axis_));
    Position at = motion.position();
    at[axis_] = homes_to_minus(settings)
                    ? pull_off - nanometres(settings.value(Setting::kTravel, axis_))
                    : -pull_off;
    motion.relocate(at);
    return next_axis(settings) ? Progress::kStepped : Progress::kFinished;
}

auto Homing::fail(Alarm alarm) noexcept -> Progress
{
    alarm_ = alarm;
    return Progress::kFailed;
}

}  // namespace cusp::machine
