// The begin and the end of homing.
#include "firmware/machine/homing_command.hpp"

namespace cusp::machine {

std::optional<Error> HomingCommand::begin(AxisMask axes) noexcept
{
    const Settings& settings = core_.settings();
    if (!settings.on(Setting::kHoming)) {
        return Error::kSettingDisabled;
    }
    if (core_.system.reset_needed()) {
        return Error::kSystemGcLock;
    }
    if (core_.input_on(kDoor)) {
        return Error::kCheckDoor;
    }
    homes_all_ = axes.empty();
    const unsigned wanted = homes_all_ ? settings.homed_axes().bits : axes.bits;
    axes_.bits = static_cast<std::uint8_t>(wanted & settings.axes_with_switches().bits);
    if (axes_.empty()) {
        return Error::kSettingDisabled;
    }
    core_.motion.guard_limits(false);
    core_.system.enter(State::kHome);
    homing_.begin(axes_, settings);
    return std::nullopt;
}

Homing::Progress HomingCommand::step() noexcept
{
    const Homing::Progress progress = homing_.step(core_.motion, core_.settings());
    if (progress == Homing::Progress::kFinished) {
        core_.system.clear_alarm();
        core_.resynchronise();
        core_.system.add_homed(axes_);
    }
    return progress;
}

}  // namespace cusp::machine
