// ToolChangeCommand: M6: a pause, or a tool change at another place with the spindle stopped.
#pragma once

#include "firmware/machine/action_progress.hpp"
#include "firmware/machine/cycle_control.hpp"
#include "firmware/machine/machine_core.hpp"
#include "firmware/machine/tool_changer.hpp"

namespace cusp::machine {

// Context: main loop.
class ToolChangeCommand {
public:
    // Both must outlive this.
    ToolChangeCommand(MachineCore& core, CycleControl& cycle) noexcept : core_{core}, cycle_{cycle}
    {
    }

    // The rule for lines with M6 as the machine is now.
    gcode::ToolChangeRule rule() const noexcept;

    // Begins the change, or the pause. Precondition: not in check mode.
    ActionProgress begin(const gcode::ToolChange& change) noexcept;
    // The machine is away from the program's path.
    bool active() const noexcept { return active_; }
    // Goes on with it. Precondition: active().
    ActionProgress step() noexcept;
    // Why it failed: kAlarm.
    Alarm alarm() const noexcept { return changer_.alarm(); }

    // The change was broken off.
    void abandon() noexcept { active_ = false; }
    // A reset: the next tool that is touched off is the first.
    void forget_reference() noexcept { changer_.forget_reference(); }

private:
    void ask_for_tool(unsigned tool) noexcept;
    void start(const gcode::ToolChange& change, ToolChangeMode mode) noexcept;
    void take_length() noexcept;

    MachineCore& core_;
    CycleControl& cycle_;
    ToolChanger changer_;
    bool active_{false};
};

}  // namespace cusp::machine
