// ProgramActions: performs the actions of a line of G-code, one after another, each with what it waits for.
//
//   read(line)  ->  step() until kLineOver, kLineFails or kAlarm
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/machine/action_progress.hpp"
#include "firmware/machine/dwell.hpp"
#include "firmware/machine/probe_command.hpp"
#include "firmware/machine/tool_change_command.hpp"

namespace cusp::machine {

// Context: main loop.
class ProgramActions {
public:
    // Both must outlive this.
    ProgramActions(MachineCore& core, CycleControl& cycle) noexcept
        : core_{core}, cycle_{cycle}, probe_{core}, tool_change_{core, cycle}
    {
    }

    // Reads a line of a program, or the words of a jog. Errors: of the interpreter; nothing is begun.
    Status read(std::string_view line) noexcept;
    Status read_jog(std::string_view words) noexcept;
    // True if the line that was read is a jog.
    bool jogs() const noexcept { return jogs_; }

    // The next step.
    ActionProgress step() noexcept;
    // The alarm of kAlarm; of kLineOver, kNone or the alarm that a probe ends in.
    Alarm alarm() const noexcept { return alarm_; }
    // Sends the result of a probe that the line has ended with.
    void tell_probe() noexcept { probe_.tell(); }

    // The next action is at hand, or waits for room: more may come soon.
    bool pushes() const noexcept { return phase_ == Phase::kNext; }
    // The machine is away from the program's path, for a tool.
    bool changing_tool() const noexcept { return tool_change_.active(); }

    // The rest of the line is dropped.
    void drop() noexcept;
    // A reset: see ToolChangeCommand.
    void forget_tool_reference() noexcept { tool_change_.forget_reference(); }

private:
    // What the line does between two actions, or in one.
    enum class Phase : std::uint8_t { kNext, kDwell, kSpindleUp, kProbe, kToolChange };

    ActionProgress next() noexcept;
    ActionProgress go_on(Phase phase) noexcept;
    ActionProgress perform(const path::Move& move) noexcept;
    ActionProgress refuse() noexcept;
    ActionProgress perform(const gcode::Probe& probe) noexcept;
    ActionProgress perform(const gcode::Dwell& dwell) noexcept;
    ActionProgress perform(const gcode::Spindle& spindle) noexcept;
    ActionProgress perform(const gcode::Coolant& coolant) noexcept;
    ActionProgress perform(const gcode::ParametersChanged& changed) noexcept;
    ActionProgress perform(const gcode::Pause& pause) noexcept;
    ActionProgress perform(const gcode::ProgramEnd& end) noexcept;
    ActionProgress perform(const gcode::ToolChange& change) noexcept;
    ActionProgress perform(const gcode::RotaryIgnored& ignored) noexcept;
    bool checks() const noexcept { return core_.system.is(State::kCheck); }

    MachineCore& core_;
    CycleControl& cycle_;
    ProbeCommand probe_;
    ToolChangeCommand tool_change_;
    Dwell dwell_;
    gcode::Action action_;
    bool action_waits_{false};
    bool jogs_{false};
    Phase phase_{Phase::kNext};
    Alarm alarm_{Alarm::kNone};
};

}  // namespace cusp::machine
