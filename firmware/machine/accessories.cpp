// Speeds to the duty cycle of the spindle's pulses.
#include "firmware/machine/accessories.hpp"

#include <algorithm>

namespace cusp::machine {
namespace {

constexpr auto kFull = static_cast<float>(kFullDuty);
constexpr float kPercent = 0.01F;

float duty_of(const Settings& settings, Setting percent) noexcept
{
    return settings.value(percent) * kPercent * kFull;
}

}  // namespace

DutyLaw::DutyLaw(const Settings& settings) noexcept
    : off_{static_cast<std::uint16_t>(duty_of(settings, Setting::kSpindleOffDuty) + 0.5F)},
      least_speed_{settings.value(Setting::kSpindleMinimum)},
      least_{std::max(duty_of(settings, Setting::kSpindleLeastDuty), 1.0F)},
      most_{std::max(duty_of(settings, Setting::kSpindleMostDuty), least_)}
{
    const float range = settings.value(Setting::kSpindleMaximum) - least_speed_;
    if (range > 0) {
        base_ = duty_of(settings, Setting::kSpindleLeastDuty);
        rise_ = (most_ - base_) / range;
    } else {
        base_ = most_;
    }
}

bool Accessories::spindle_starts_after(const Accessories& before) const noexcept
{
    const bool turned =
        before.spindle_on() && before.spindle == spindle && (before.speed > 0 || speed <= 0);
    return spindle_on() && !turned;
}

std::uint32_t spindle_ticks(const Settings& settings) noexcept
{
    constexpr auto kTicksPerSecond = static_cast<float>(kServoTicksPerSecond);
    return static_cast<std::uint32_t>(settings.value(Setting::kSpindleDelay) * kTicksPerSecond +
                                      0.5F);
}

std::uint32_t restoring_ticks(const Accessories& accessories, const Settings& settings) noexcept
{
    constexpr std::uint32_t kSpindleUp = 4000;
    constexpr std::uint32_t kCoolantOn = 1000;
    const bool coolant = accessories.flood_on() || accessories.mist_on();
    if (!accessories.spindle_on()) {
        return coolant ? kCoolantOn : 0U;
    }
    if (settings.on(Setting::kLaserMode)) {
        return coolant ? kCoolantOn : 0U;
    }
    return settings.on(Setting::kSpindleDelay) ? spindle_ticks(settings) : kSpindleUp;
}

float spindle_speed(const Accessories& accessories,
                    unsigned override_percent,
                    const Settings& settings) noexcept
{
    if (!accessories.spindle_on() || accessories.speed <= 0) {
        return 0;
    }
    const float least = settings.value(Setting::kSpindleMinimum);
    const float most = settings.value(Setting::kSpindleMaximum);
    const float wanted = accessories.speed * static_cast<float>(override_percent) * kPercent;
    return least >= most ? most : std::clamp(wanted, least, most);
}

OutputLevels output_levels(const Accessories& accessories,
                           unsigned spindle_override_percent,
                           AxisMask drives,
                           const Settings& settings) noexcept
{
    OutputLevels levels;
    levels.spindle_on = accessories.spindle_on();
    levels.spindle_reverse =
        levels.spindle_on && accessories.spindle == gcode::SpindleMode::kCounterClockwise;
    const DutyLaw law{settings};
    levels.follows_speed = levels.spindle_on && settings.on(Setting::kLaserMode);
    levels.spindle_pwm =
        levels.follows_speed
            ? law.duty(0)
            : law.duty(spindle_speed(accessories, spindle_override_percent, settings));
    levels.spindle_off_pwm = law.duty(0);
    levels.spindle_hz = settings.whole(Setting::kSpindleFrequency);
    levels.flood = accessories.flood_on();
    levels.mist = accessories.mist_on();
    constexpr unsigned kAxes = 7;
    // A drive that no axis has goes with all of them.
    const std::optional<unsigned> doubled = settings.second_motor_axis();
    const bool fourth = doubled                 ? drives.contains(*doubled)
                        : settings.has_rotary() ? drives.contains(kLinearAxes)
                                                : (drives.bits & kAxes) == kAxes;
    constexpr unsigned kFourthDrive = 1U << kLinearAxes;
    levels.drives_on =
        static_cast<std::uint8_t>((drives.bits & kAxes) | (fourth ? kFourthDrive : 0U));
    const unsigned steps = settings.whole(Setting::kStepInvert);
    const unsigned directions = settings.whole(Setting::kDirectionInvert);
    levels.inverted_lines = 0;
    for (unsigned axis = 0; axis < settings.axes(); ++axis) {
        levels.inverted_lines |=
            static_cast<PulseLines>((steps >> axis & 1U) * step_line(axis) |
                                    (directions >> axis & 1U) * direction_line(axis));
    }
    if (const std::optional<unsigned> axis = doubled) {
        const unsigned turned = settings.whole(Setting::kSecondInvert) ^ directions;
        levels.inverted_lines |=
            static_cast<PulseLines>((steps >> *axis & 1U) * kSecondStepLine |
                                    (turned >> *axis & 1U) * kSecondDirectionLine);
    }
    levels.drives_enable_inverted = settings.on(Setting::kEnableInvert);
    const unsigned coolant = settings.whole(Setting::kCoolantInvert) & (kFloodOutput | kMistOutput);
    constexpr unsigned kSpindleOutputs = 7;
    constexpr unsigned kFirstOfSpindle = 2;
    const unsigned spindle = settings.whole(Setting::kSpindleInvert) & kSpindleOutputs;
    levels.inverted_outputs = static_cast<std::uint8_t>(coolant | spindle << kFirstOfSpindle);
    return levels;
}

}  // namespace cusp::machine
