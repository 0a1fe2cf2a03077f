// HomingCommand: `$H`: who may home, which axes, and what the machine is afterwards.
#pragma once

#include <optional>

#include "firmware/machine/homing.hpp"
#include "firmware/machine/machine_core.hpp"

namespace cusp::machine {

// Context: main loop.
class HomingCommand {
public:
    // `core` must outlive this.
    explicit HomingCommand(MachineCore& core) noexcept : core_{core} {}

    // Begins the cycle: then the state is Home. `axes`: empty for all that home.
    // Errors: kSettingDisabled, kSystemGcLock, kCheckDoor.
    std::optional<Error> begin(AxisMask axes) noexcept;

    // Performs its next step. Once it is finished the machine is idle, and knows where it is.
    Homing::Progress step() noexcept;

    // Why it failed.
    Alarm alarm() const noexcept { return homing_.alarm(); }
    // True if the last cycle was that of all axes that home.
    bool homes_all() const noexcept { return homes_all_; }

private:
    MachineCore& core_;
    Homing homing_;
    AxisMask axes_;
    bool homes_all_{false};
};

}  // namespace cusp::machine
