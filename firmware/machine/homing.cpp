// The phases of homing.
#include "firmware/machine/homing.hpp"

namespace cusp::machine {
namespace {

constexpr unsigned kAllAxes = 7;
// Distances of search, as in Grbl: over the travel, and over the pull-off.
constexpr float kSeekOverTravel = 1.5F;
constexpr float kLocateOverPullOff = 5.0F;
constexpr float kSecondsPerMinute = 60.0F;

std::int64_t nanometres(float mm) noexcept { return to_nanometres(static_cast<double>(mm)); }

}  // namespace

void Homing::begin(AxisMask axes, const Settings& /*settings*/) noexcept
{
    axes_ = axes.empty() ? AxisMask{kAllAxes} : axes;
    alarm_ = Alarm::kNone;
    moving_ = false;
    resting_ = false;
    (void)next_axis();
}

bool Homing::homes_to_minus(const Settings& settings) const noexcept
{
    return (settings.whole(Setting::kHomingDirection) >> axis_ & 1U) != 0;
}

// Z first, so that the tool is up before the table moves.
bool Homing::next_axis() noexcept
{
    constexpr std::array<unsigned, kAxisCount> kOrder{2, 0, 1};
    for (const unsigned axis : kOrder) {
        if (axes_.contains(axis)) {
            axis_ = axis;
            axes_.bits = static_cast<std::uint8_t>(axes_.bits & ~(1U << axis));
            phase_ = Phase::kSeek;
            return true;
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
        if (!motion.settled() || !motion.make_room()) {
            return Progress::kWaiting;
        }
        start_phase(motion, settings);
        return Progress::kStepped;
    }
    const bool stopped = motion.contact() ? motion.at_rest() : motion.settled();
    if (!stopped) {
        return Progress::kWaiting;
    }
    if (motion.contact()) {
        contact_ = (*motion.contact())[axis_];
    }
    motion.abandon();
    moving_ = false;
    // Switches bounce: give them their time before the next look.
    resting_ = true;
    rest_until_ = motion.ticks() + settings.whole(Setting::kHomingDebounce);
    return Progress::kStepped;
}

void Homing::start_phase(Motion& motion, const Settings& settings) noexcept
{
    const float pull_off = settings.value(Setting::kHomingPullOff);
    const std::int64_t sign = homes_to_minus(settings) ? -1 : 1;
    const bool searches = phase_ == Phase::kSeek || phase_ == Phase::kLocate;
    if (searches) {
        const float distance = phase_ == Phase::kSeek
                                   ? kSeekOverTravel * settings.value(Setting::kTravel, axis_)
                                   : kLocateOverPullOff * pull_off;
        motion.watch({static_cast<std::uint16_t>(unsigned{kLimitX} << axis_), false, true});
        go(motion, sign * nanometres(distance),
           settings.value(phase_ == Phase::kSeek ? Setting::kHomingSeek : Setting::kHomingFeed));
    } else {
        motion.watch({});
        const std::int64_t target = contact_ - sign * nanometres(pull_off);
        go(motion, target - motion.tail()[axis_], settings.value(Setting::kHomingSeek));
    }
    moving_ = true;
}

void Homing::go(Motion& motion, std::int64_t distance, float mm_per_minute) const noexcept
{
    path::Move move;
    move.kind = path::MoveKind::kFeed;
    move.start = motion.tail();
    move.end = move.start;
    move.end[axis_] += distance;
    move.feed = mm_per_minute / kSecondsPerMinute;
    motion.push(move);
    motion.close();
}

auto Homing::finish_phase(Motion& motion, const Settings& settings) noexcept -> Progress
{
    const bool closed = (unsigned{motion.inputs().steady()} >> axis_ & 1U) != 0;
    const bool found = motion.contact().has_value();
    switch (phase_) {
        case Phase::kSeek:
        case Phase::kLocate:
            if (!found) {
                return fail(Alarm::kHomingApproach);
            }
            phase_ = phase_ == Phase::kSeek ? Phase::kFirstPullOff : Phase::kSecondPullOff;
            return Progress::kStepped;
        case Phase::kFirstPullOff:
        case Phase::kSecondPullOff:
            if (closed) {
                return fail(Alarm::kHomingPullOff);
            }
            if (phase_ == Phase::kFirstPullOff) {
                phase_ = Phase::kLocate;
                return Progress::kStepped;
            }
            break;
    }
    return finish_axis(motion, settings);
}

auto Homing::finish_axis(Motion& motion, const Settings& settings) noexcept -> Progress
{
    const std::int64_t pull_off = nanometres(settings.value(Setting::kHomingPullOff));
    Position at = motion.position();
    at[axis_] = homes_to_minus(settings)
                    ? pull_off - nanometres(settings.value(Setting::kTravel, axis_))
                    : -pull_off;
    motion.relocate(at);
    return next_axis() ? Progress::kStepped : Progress::kFinished;
}

auto Homing::fail(Alarm alarm) noexcept -> Progress
{
    alarm_ = alarm;
    return Progress::kFailed;
}

}  // namespace cusp::machine
