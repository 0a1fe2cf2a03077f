// Switches outputs on and off, pauses them, and counts the time until they are up.
#include "firmware/machine/output_control.hpp"

namespace cusp::machine {

using protocol::RealtimeCommand;

float OutputControl::spindle_speed() const noexcept
{
    return settings_.on(Setting::kLaserMode)
               ? motion_.laser().speed()
               : machine::spindle_speed(accessories_, overrides_.spindle, settings_);
}

OutputLevels OutputControl::levels(bool stopped) const noexcept
{
    // $1: ms that the drives stay on after the last step; 255: always. Before the first move they
    // are off unless it is 255.
    constexpr std::uint32_t kAlwaysOn = 255;
    const std::uint32_t idle_lock = settings_.whole(Setting::kIdleLock);
    const bool still = motion_.settled() && motion_.ticks() - still_since_ >= idle_lock;
    const AxisMask axes{static_cast<std::uint8_t>((1U << settings_.axes()) - 1)};
    const bool all = idle_lock == kAlwaysOn || (has_moved_ && !still);
    const AxisMask kept{static_cast<std::uint8_t>(settings_.whole(Setting::kKeepCurrent))};
    const AxisMask drives = stopped ? AxisMask{} : all ? axes : kept;
    return output_levels(accessories_, overrides_.spindle, drives, settings_);
}

bool OutputControl::follow() noexcept
{
    if (!motion_.settled()) {
        still_since_ = motion_.ticks();
        has_moved_ = true;
    }
    if (!coming_up_) {
        return true;
    }
    const bool time_is_over = static_cast<std::int32_t>(motion_.ticks() - up_at_) >= 0;
    if (!waits_for_spindle()) {
        coming_up_ = !time_is_over;
        return true;
    }
    // Its drive needs a moment to take back what it said of the speed before.
    constexpr std::uint32_t kHeedless = 100;
    const bool heeds = motion_.ticks() - switched_at_ >= kHeedless;
    coming_up_ = !heeds || !says_at_speed();
    return !coming_up_ || !time_is_over;
}

void OutputControl::tell_vfd(bool cut) noexcept
{
    const bool turns = accessories_.spindle_on() && !cut;
    const bool clockwise = accessories_.spindle == gcode::SpindleMode::kClockwise;
    vfd_.want(!turns      ? vfd::Turning::kOff
              : clockwise ? vfd::Turning::kClockwise
                          : vfd::Turning::kCounterClockwise,
              machine::spindle_speed(accessories_, overrides_.spindle, settings_));
}

bool OutputControl::says_at_speed() const noexcept
{
    const bool by_input =
        !settings_.on(Setting::kAtSpeedInput) || (motion_.inputs().steady() & kAtSpeed) != 0;
    return by_input && vfd_.at_speed();
}

void OutputControl::override_by(RealtimeCommand command) noexcept
{
    const Overrides before = overrides_;
    overrides_ = overridden(overrides_, command);
    if (!(before == overrides_)) {
        set_overrides();
        reporter_.overrides_changed();
    }
}

void OutputControl::set_overrides() noexcept
{
    motion_.set_overrides(overrides_.feed, overrides_.rapid);
    motion_.laser().set_override(overrides_.spindle);
}

void OutputControl::reset_overrides() noexcept
{
    overrides_ = Overrides{};
    set_overrides();
}

path::LaserPower OutputControl::laser_power(const path::Move& move) const noexcept
{
    if (!settings_.on(Setting::kLaserMode) || move.kind != path::MoveKind::kFeed) {
        return {};
    }
    switch (accessories_.spindle) {
        case gcode::SpindleMode::kOff:
            break;
        case gcode::SpindleMode::kClockwise:
            return path::LaserPower::constant(accessories_.speed);
        case gcode::SpindleMode::kCounterClockwise:
            return path::LaserPower::by_length(accessories_.speed, move.feed);
    }
    return {};
}

bool OutputControl::set_spindle(gcode::SpindleMode mode, float speed) noexcept
{
    const Accessories before = accessories_;
    accessories_.spindle = mode;
    accessories_.speed = speed;
    accessories_.spindle_paused = false;
    reporter_.overrides_changed();
    // A drive that is spoken to says whether it has another speed, too.
    const bool other_speed =
        settings_.has_vfd() && accessories_.spindle_on() && speed > 0 && speed != before.speed;
    const bool starts = (accessories_.spindle_starts_after(before) || other_speed) &&
                        !settings_.on(Setting::kLaserMode);
    if (starts) {
        wait_until_up(waits_for_spindle() ? restoring_ticks(accessories_, settings_)
                                          : spindle_ticks(settings_));
    }
    return starts;
}

void OutputControl::set_coolant(bool flood, bool mist) noexcept
{
    accessories_.flood = flood;
    accessories_.mist = mist;
    interpreter_.set_coolant(flood, mist);
    reporter_.overrides_changed();
}

void OutputControl::toggle_coolant(RealtimeCommand command) noexcept
{
    const bool flood = accessories_.flood;
    const bool mist = accessories_.mist;
    const bool of_flood = command == RealtimeCommand::kFloodToggle;
    set_coolant(of_flood ? !flood : flood, of_flood ? mist : !mist);
}

void OutputControl::switch_off() noexcept
{
    accessories_ = Accessories{};
    coming_up_ = false;
    interpreter_.set_coolant(false, false);
    interpreter_.set_spindle_off();
    reporter_.overrides_changed();
}

void OutputControl::end_program() noexcept
{
    accessories_ = Accessories{};
    reset_overrides();
    reporter_.overrides_changed();
}

void OutputControl::pause() noexcept
{
    accessories_.spindle_paused = true;
    accessories_.coolant_paused = true;
}

void OutputControl::restore() noexcept
{
    if (accessories_.spindle_paused || accessories_.coolant_paused) {
        accessories_.spindle_paused = false;
        accessories_.coolant_paused = false;
        reporter_.overrides_changed();
        wait_until_up(restoring_ticks(accessories_, settings_));
    }
}

bool OutputControl::can_pause_spindle() const noexcept
{
    return !accessories_.changing_tool && accessories_.spindle != gcode::SpindleMode::kOff;
}

bool OutputControl::toggle_spindle_pause() noexcept
{
    accessories_.spindle_paused = !accessories_.spindle_paused;
    reporter_.overrides_changed();
    if (!accessories_.spindle_paused) {
        wait_until_up(restoring_ticks(accessories_, settings_));
    }
    return accessories_.spindle_paused;
}

void OutputControl::begin_tool_change() noexcept
{
    accessories_.changing_tool = true;
    reporter_.overrides_changed();
}

void OutputControl::end_tool_change() noexcept
{
    accessories_.changing_tool = false;
    reporter_.overrides_changed();
    wait_until_up(restoring_ticks(accessories_, settings_));
}

void OutputControl::wait_until_up(std::uint32_t ticks) noexcept
{
    coming_up_ = true;
    switched_at_ = motion_.ticks();
    up_at_ = switched_at_ + ticks;
}

}  // namespace cusp::machine
