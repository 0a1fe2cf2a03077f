// Moves in, frames out.
#include "firmware/machine/motion.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::machine {
namespace {

// The inputs of $14's bits, which are grblHAL's.
unsigned control_inputs(unsigned mask) noexcept
{
    struct Bit {
        unsigned setting;
        InputBit input;
    };
    constexpr std::array<Bit, 6> kBits{{{1U << 0U, kResetButton},
                                        {1U << 1U, kHoldButton},
                                        {1U << 2U, kStartButton},
                                        {1U << 3U, kDoor},
                                        {1U << 6U, kEmergencyStop},
                                        {1U << 8U, kMotorFault}}};
    unsigned inputs = 0;
    for (const Bit& bit : kBits) {
        inputs |= (mask & bit.setting) != 0 ? unsigned{bit.input} : 0U;
    }
    return inputs;
}

MachineLimits limits_of_the_way(const Settings& settings) noexcept
{
    return Backlash::left_of(settings.limits(), settings.backlash());
}

}  // namespace

Motion::Motion(planner::PathQueue& queue, const Settings& settings) noexcept
    : planner_{queue, limits_of_the_way(settings)}, pulses_{settings.steps()}
{
    configure(settings);
}

void Motion::configure(const Settings& settings) noexcept
{
    gate_shut_.store(true, std::memory_order_release);
    stand_still(true);
    const MachineLimits limits = limits_of_the_way(settings);
    const Position at = interpolator_.position();
    planner_.set_limits(limits);
    planner_.reset(at);
    planner_.set_shaper(settings.input_shaper());
    interpolator_.reset(at);
    backlash_.configure(settings.backlash(), settings.limits());
    pulses_.configure(settings.steps());
    put_motors(at);
    least_acceleration_ = limits.acceleration.x;
    path_filter_s_ = 0;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        least_acceleration_ = std::min(least_acceleration_, limits.acceleration[axis]);
        path_filter_s_ = std::max(path_filter_s_, limits.acceleration[axis] / limits.jerk[axis]);
    }
    const unsigned limit_bits = settings.on(Setting::kLimitInvert) ? kLimitInputs : 0U;
    const unsigned probe_bit = settings.on(Setting::kProbeInvert) ? unsigned{kProbe} : 0U;
    const unsigned control_bits = control_inputs(settings.whole(Setting::kControlInvert));
    inverted_inputs_ = static_cast<std::uint16_t>(limit_bits | probe_bit | control_bits | kAtSpeed);
    second_motor_axis_ = settings.second_motor_axis();
    const unsigned unused = (settings.has_fourth_switch() ? 0U : unsigned{kFourthLimit}) |
                            (settings.on(Setting::kAtSpeedInput) ? 0U : unsigned{kAtSpeed});
    used_inputs_ = static_cast<std::uint16_t>(0xFFFFU & ~unused);
    laser_.configure(settings);
    filter_ticks_ = static_cast<std::uint8_t>(settings.whole(Setting::kLimitFilter));
    inputs_.set_ticks(filter_ticks_);
    stand_still(false);
    gate_shut_.store(false, std::memory_order_release);
}

void Motion::push(const path::Move& move) noexcept
{
    planner_.push(move);
    last_push_tick_ = ticks();
    open_ = true;
    changed_ = true;
}

void Motion::close() noexcept
{
    if (open_) {
        planner_.close();
        open_ = false;
        changed_ = true;
    }
}

void Motion::work(bool more_waits) noexcept
{
    plans_ = false;
    if (!planner_.empty()) {
        plans_ = planner_.work(open_ && !more_waits && ticks() != last_push_tick_);
    }
    // A sender that waits for each answer needs a moment to send the next line. At rest more is worth
    // waiting for: a path that goes on need not stop.
    constexpr std::uint32_t kPatienceTicks = 5;
    constexpr std::uint32_t kPatienceAtRest = 15;
    const std::uint32_t patience = interpolator_.at_rest() ? kPatienceAtRest : kPatienceTicks;
    if (!open_ || more_waits || ticks() - last_push_tick_ < patience) {
        return;
    }
    const float v = speed();
    const float braking =
        v * (0.05F + 2.0F * path_filter_s_) + v * v / (2.0F * least_acceleration_);
    const float left = interpolator_.path_ahead();
    if (interpolator_.at_rest() || left < braking) {
        close();
    }
}

bool Motion::take_changes() noexcept
{
    if (changed_) {
        changed_ = false;
        plans_ = planner_.work();
    }
    return plans_;
}

Position Motion::position() const noexcept
{
    // A tick between the words of a position shows in the counter; a second one can't come so soon.
    const std::uint32_t before = ticks();
    Position at = set_point_;
    if (ticks() != before) {
        at = set_point_;
    }
    return at;
}

void Motion::set_overrides(unsigned feed_percent, unsigned rapid_percent) noexcept
{
    interpolator_.set_feed_override(feed_percent);
    interpolator_.set_rapid_override(rapid_percent);
}

void Motion::resume() noexcept
{
    const bool touched =
        watched_.load(std::memory_order_acquire) != 0 && contacted_.load(std::memory_order_acquire);
    if (!touched) {
        interpolator_.resume();
    }
}

void Motion::abandon() noexcept
{
    gate_shut_.store(true, std::memory_order_release);
    const Position at = set_point_;
    planner_.reset(at);
    interpolator_.reset(at);
    backlash_.stop();
    open_ = false;
    changed_ = false;
    unwatch();
    limit_hit_.store(false, std::memory_order_relaxed);
    halted_.store(false, std::memory_order_relaxed);
    gate_shut_.store(false, std::memory_order_release);
}

// Makes no step. Precondition: stands_still_.
void Motion::put_motors(Position at) noexcept
{
    motors_ = at;
    backlash_.rest(at);
    pulses_.reset(at);
}

void Motion::lose_frames() noexcept
{
    gate_shut_.store(true, std::memory_order_release);
    stand_still(true);
    played_ = set_point_;
    put_motors(set_point_);
    pulses_.lose_frames(set_point_);
    halted_.store(true, std::memory_order_release);
    stand_still(false);
    gate_shut_.store(false, std::memory_order_release);
}

void Motion::relocate(Position at) noexcept
{
    gate_shut_.store(true, std::memory_order_release);
    stand_still(true);
    planner_.reset(at);
    interpolator_.reset(at);
    put_motors(at);
    set_point_ = at;
    played_ = at;
    stand_still(false);
    gate_shut_.store(false, std::memory_order_release);
}

void Motion::drive(Motors motors) noexcept
{
    if (!second_motor_axis_) {
        return;
    }
    const PulseLines first = step_line(*second_motor_axis_);
    const PulseLines lines = motors == Motors::kFirst ? first
                             : motors == Motors::kFourth
                                 ? kSecondStepLine
                                 : static_cast<PulseLines>(first | kSecondStepLine);
    pulses_.set_step_lines(*second_motor_axis_, lines);
}

void Motion::watch(Watch watch) noexcept
{
    unwatch();
    contacted_.store(false, std::memory_order_relaxed);
    contacted_later_.store(false, std::memory_order_relaxed);
    contact_.ticks = 0;
    later_contact_.ticks = 0;
    watch_off_ = watch.off;
    watch_filtered_ = watch.filtered;
    watched_.store(watch.inputs, std::memory_order_release);
}

std::optional<Position> Motion::contact() const noexcept
{
    if (!contacted_.load(std::memory_order_acquire)) {
        return std::nullopt;
    }
    return contact_.at;
}

std::optional<Position> Motion::later_contact() const noexcept
{
    if (!contacted_later_.load(std::memory_order_acquire)) {
        return std::nullopt;
    }
    return later_contact_.at;
}

void Motion::tick(std::uint16_t raw_inputs, PulseFrame& frame) noexcept
{
    const Position before = set_point_;
    if (!gate_shut_.load(std::memory_order_acquire)) {
        sample(raw_inputs);
        const bool ends =
            limit_hit_.load(std::memory_order_relaxed) || halted_.load(std::memory_order_relaxed);
        if (!ends) {
            set_point_ = interpolator_.tick();
            motors_ = backlash_.follow(set_point_);
        } else {
            backlash_.stop();
        }
    }
    if (laser_.on()) {
        laser_.tick(interpolator_.power(), interpolator_.speed() <= 0,
                    interpolator_.smoothing_ticks(), set_point_ - before);
    }
    played_ = before;
    if (stands_still_.load(std::memory_order_acquire)) {
        frame.edges.clear();
    } else {
        pulses_.make_frame(motors_, frame);
    }
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

void Motion::sample(std::uint16_t raw_inputs) noexcept
{
    inputs_.sample(static_cast<std::uint16_t>((raw_inputs ^ inverted_inputs_) & used_inputs_));
    stops_.take_inputs(inputs_.raw(), inputs_.steady());
    interpolator_.brake(stops_.brakes());
    if (stops_.halts() && !at_rest()) {
        halted_.store(true, std::memory_order_release);
    }
    if (guarding_.load(std::memory_order_relaxed) && (inputs_.steady() & kLimitInputs) != 0) {
        limit_hit_.store(true, std::memory_order_release);
    }
    if (watched_.load(std::memory_order_acquire) != 0) {
        check_watch();
    }
}

void Motion::check_watch() noexcept
{
    const unsigned watched = watched_.load(std::memory_order_relaxed);
    if (!contacted_.load(std::memory_order_relaxed)) {
        const bool long_enough = answered(contact_, watched);
        if (contact_.ticks == 0) {
            later_contact_.ticks = 0;
            return;
        }
        if (contact_.ticks == 1) {
            contact_inputs_ = static_cast<std::uint16_t>(inputs_.raw() & watched);
        }
        if (long_enough) {
            interpolator_.hold();
            contacted_.store(true, std::memory_order_release);
        }
    }
    if (!contacted_later_.load(std::memory_order_relaxed) &&
        answered(later_contact_, watched & ~unsigned{contact_inputs_})) {
        contacted_later_.store(true, std::memory_order_release);
    }
}

bool Motion::answered(Answer& answer, unsigned inputs) noexcept
{
    const unsigned on = unsigned{inputs_.raw()} & inputs;
    if (inputs == 0 || (watch_off_ ? on != 0 : on == 0)) {
        answer.ticks = 0;
        return false;
    }
    if (answer.ticks == 0) {
        answer.at = played_;
    }
    ++answer.ticks;
    return !watch_filtered_ || answer.ticks > filter_ticks_;
}

}  // namespace cusp::machine
