// The phases of a tool change.
#include "firmware/machine/tool_changer.hpp"

#include <algorithm>

#include "firmware/gcode/tool_table.hpp"
#include "firmware/machine/report_units.hpp"
#include "firmware/machine/travel.hpp"

namespace cusp::machine {
namespace {

constexpr float kBackOffMillimetres = 2.0F;
// The slow search goes so far beyond where the fast one touched.
constexpr float kLocateBeyond = 2.0F;
constexpr unsigned kAxisZ = 2;

std::int64_t nanometres_of(float mm) noexcept { return to_nanometres(static_cast<double>(mm)); }

// As far up as homing leaves Z where it homes upwards: the limit switch stays open.
std::int64_t top_of(const Settings& settings) noexcept
{
    return -nanometres_of(settings.pull_off(kAxisZ));
}

std::int64_t bottom_of(const Settings& settings) noexcept
{
    return -nanometres_of(settings.value(Setting::kTravel, kAxisZ));
}

// A place at another height.
Position at_height(Position at, std::int64_t z) noexcept
{
    at.z = z;
    return at;
}

// Over or below another place, A where it is.
Position over(Position place, Position at) noexcept
{
    at.x = place.x;
    at.y = place.y;
    return at;
}

bool in_travel(Position at, const Settings& settings) noexcept
{
    path::Move move;
    move.start = at;
    move.end = at;
    return within_travel(move, settings);
}

}  // namespace

ToolChangeMode tool_change_mode(const Settings& settings) noexcept
{
    return static_cast<ToolChangeMode>(settings.whole(Setting::kToolChangeMode));
}

AxisMask axes_to_home(ToolChangeMode mode) noexcept
{
    constexpr std::uint8_t kZ = 4;
    constexpr std::uint8_t kAll = 7;
    switch (mode) {
        case ToolChangeMode::kAtTop:
            return {kZ};
        case ToolChangeMode::kAtPlace:
        case ToolChangeMode::kTouchOff:
            return {kAll};
        case ToolChangeMode::kPause:
        case ToolChangeMode::kIgnore:
            break;
    }
    return {};
}

void ToolChanger::begin(const Change& change, const Motion& motion) noexcept
{
    change_ = change;
    back_ = motion.tail();
    length_nm_ = change.offset_nm;
    phase_ = Phase::kLift;
    moving_ = false;
    resting_ = false;
    alarm_ = Alarm::kNone;
}

bool ToolChanger::leaves_out(Phase phase) const noexcept
{
    switch (phase) {
        case Phase::kToPlace:
            return change_.mode == ToolChangeMode::kAtTop;
        case Phase::kLower:
            return change_.mode != ToolChangeMode::kAtPlace;
        case Phase::kApproach:
        case Phase::kSeek:
        case Phase::kBackOff:
        case Phase::kLocate:
            return change_.mode != ToolChangeMode::kTouchOff;
        case Phase::kLift:
        case Phase::kChange:
        case Phase::kLiftAgain:
        case Phase::kBack:
        case Phase::kOverPart:
        case Phase::kDescend:
        case Phase::kDone:
            break;
    }
    return false;
}

void ToolChanger::next_phase() noexcept
{
    do {
        phase_ = static_cast<Phase>(static_cast<unsigned>(phase_) + 1U);
    } while (leaves_out(phase_));
}

auto ToolChanger::step(Motion& motion, const Settings& settings) noexcept -> Progress
{
    if (resting_) {
        if (static_cast<std::int32_t>(motion.ticks() - rest_until_) < 0) {
            return Progress::kWaiting;
        }
        resting_ = false;
    }
    if (!moving_) {
        const bool ready = motion.settled() && motion.has_room();
        return ready ? start_phase(motion, settings) : Progress::kWaiting;
    }
    const bool probing = phase_ == Phase::kSeek || phase_ == Phase::kLocate;
    const bool stopped = probing && motion.contact() ? motion.at_rest() : motion.settled();
    if (!stopped) {
        return Progress::kWaiting;
    }
    moving_ = false;
    return finish_phase(motion, settings);
}

auto ToolChanger::start_phase(Motion& motion, const Settings& settings) noexcept -> Progress
{
    const Position at = motion.tail();
    const std::int64_t top = top_of(settings);
    switch (phase_) {
        case Phase::kLift:
            if (change_.mode != ToolChangeMode::kAtTop && !in_travel(change_.place, settings)) {
                return fail(Alarm::kSoftLimit);
            }
            return travel(motion, at_height(at, std::max(at.z, top)));
        case Phase::kToPlace:
            return travel(motion, over(change_.place, at));
        case Phase::kLower:
        case Phase::kApproach:
            return travel(motion, at_height(at, std::min(change_.place.z, top)));
        case Phase::kChange:
            return stepped(Progress::kAtChange);
        case Phase::kSeek:
        case Phase::kLocate:
            return probe(motion, settings);
        case Phase::kBackOff:
            push(motion, at_height(at, contact_z_ + nanometres_of(kBackOffMillimetres)),
                 path::MoveKind::kFixedFeed, settings.value(Setting::kToolSeek));
            moving_ = true;
            return Progress::kStepped;
        case Phase::kLiftAgain:
            return travel(motion, at_height(at, std::max(at.z, top)));
        case Phase::kBack:
            return travel(motion, over(back_, at));
        case Phase::kOverPart:
            return stepped(Progress::kOverPart);
        case Phase::kDescend:
            return travel(motion, back_);
        case Phase::kDone:
            break;
    }
    return Progress::kFinished;
}

auto ToolChanger::finish_phase(Motion& motion, const Settings& settings) noexcept -> Progress
{
    if (phase_ != Phase::kSeek && phase_ != Phase::kLocate) {
        return stepped(Progress::kStepped);
    }
    const std::optional<Position> contact = motion.contact();
    motion.abandon();
    if (!contact) {
        return fail(Alarm::kProbeContact);
    }
    if (phase_ == Phase::kSeek) {
        contact_z_ = contact->z;
        return stepped(Progress::kStepped);
    }
    return measure(contact->z, settings);
}

auto ToolChanger::travel(Motion& motion, Position to) noexcept -> Progress
{
    if (to == motion.tail()) {
        return stepped(Progress::kStepped);
    }
    push(motion, to, path::MoveKind::kRapid, 0);
    moving_ = true;
    return Progress::kStepped;
}

// Down until the tool touches. As with G38.2 the probe must be open before.
auto ToolChanger::probe(Motion& motion, const Settings& settings) noexcept -> Progress
{
    if ((motion.inputs().raw() & kProbe) != 0) {
        return fail(Alarm::kProbeInitial);
    }
    const bool seeks = phase_ == Phase::kSeek;
    const float distance =
        seeks ? settings.value(Setting::kToolSearch) : kBackOffMillimetres + kLocateBeyond;
    Position to = motion.tail();
    to.z = std::max(to.z - nanometres_of(distance), bottom_of(settings));
    if (to == motion.tail()) {
        return fail(Alarm::kProbeContact);
    }
    motion.watch({kProbe, false, false});
    push(motion, to, path::MoveKind::kFixedFeed,
         settings.value(seeks ? Setting::kToolSeek : Setting::kToolFeed));
    moving_ = true;
    return Progress::kStepped;
}

auto ToolChanger::measure(std::int64_t contact_z, const Settings& settings) noexcept -> Progress
{
    if (!reference_z_) {
        reference_z_ = contact_z - change_.first_length_nm;
    }
    const std::int64_t length = contact_z - *reference_z_;
    back_.z += length - change_.offset_nm;
    if (!gcode::fits_tool_table(length) || !in_travel(back_, settings)) {
        return fail(Alarm::kSoftLimit);
    }
    length_nm_ = length;
    return stepped(Progress::kMeasured);
}

void ToolChanger::push(Motion& motion,
                       Position to,
                       path::MoveKind kind,
                       float mm_per_minute) const noexcept
{
    path::Move move;
    move.kind = kind;
    move.start = motion.tail();
    move.end = to;
    move.feed = mm_per_minute / kSecondsPerMinute;
    move.line = change_.line;
    motion.push(move);
    motion.close();
}

auto ToolChanger::stepped(Progress progress) noexcept -> Progress
{
    next_phase();
    return progress;
}

auto ToolChanger::fail(Alarm alarm) noexcept -> Progress
{
    alarm_ = alarm;
    return Progress::kFailed;
}

}  // namespace cusp::machine
