// LineExecution: one line at a time, from its text to its answer: read, performed, waited for.
//
//   step()  ->  reads the next line, or goes on with the one that waits
//
// What concerns the whole machine (alarms, a reset, new settings) is the caller's: LineEvent.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/machine/homing_command.hpp"
#include "firmware/machine/program_actions.hpp"
#include "firmware/machine/reports.hpp"
#include "firmware/machine/startup_lines.hpp"
#include "firmware/machine/system_commands.hpp"

namespace cusp::machine {

enum class LineEvent : std::uint8_t {
    kNothing,
    kWorked,
    kAlarm,       // alarm() is to be raised, and the line answered with an error
    kProbeAlarm,  // alarm() is to be raised, then finish_probe()
    kConfigure,   // new settings are to take effect
    kReset,       // the line was answered, and the machine is to be reset
};

// Context: main loop.
class LineExecution {
public:
    // All must outlive this.
    LineExecution(MachineCore& core, CycleControl& cycle, Reports& reports) noexcept
        : core_{core}, cycle_{cycle}, reports_{reports}
    {
    }

    // One step. `drives_ready`: something may move or be switched on; until then such lines wait.
    LineEvent step(bool drives_ready) noexcept;
    Alarm alarm() const noexcept { return alarm_; }
    // The alarm of kProbeAlarm is raised: the result of the probe, and the answer.
    void finish_probe() noexcept;

    // A line waits for what it began.
    bool waits() const noexcept { return task_ != Task::kNone; }
    bool homes() const noexcept { return task_ == Task::kHome; }
    // Moves of a program may come soon.
    bool pushes() const noexcept { return task_ == Task::kActions && actions_.pushes(); }
    bool changing_tool() const noexcept { return actions_.changing_tool(); }
    // True if an alarm has to answer the sender's line.
    bool owes_answer() const noexcept
    {
        return (waits() && ending_ != Ending::kStartupLine) || startup_.answer_waits();
    }

    const StartupLines& startup() const noexcept { return startup_; }
    void run_startup_lines() noexcept { startup_.run(); }
    // The jog that still waits for room is given up, with "ok".
    void cancel_jog() noexcept;
    // The line, and startup lines, are dropped without an answer.
    void drop() noexcept;
    // A reset: the next tool that is touched off is the first.
    void forget_tool_reference() noexcept { actions_.forget_tool_reference(); }

private:
    // What the line waits for.
    enum class Task : std::uint8_t {
        kNone,
        kActions,  // ProgramActions
        kHome,
        kListing,
        kConfigure,  // motion to settle, then the new settings
        kFinish,     // the store, then the answer
    };
    // What its end is.
    enum class Ending : std::uint8_t { kAnswer, kStartupLine, kKeepStartupLine };

    LineEvent read() noexcept;
    LineEvent next_startup_line() noexcept;
    void execute_text(std::string_view text) noexcept;
    void execute_command(std::string_view text) noexcept;
    void execute_gcode(std::string_view text, Ending ending) noexcept;
    void finish(std::optional<Error> error) noexcept;
    // kWorked, or kReset once the line is answered.
    LineEvent worked() noexcept;
    LineEvent go_on() noexcept;
    LineEvent step_actions() noexcept;
    LineEvent step_home() noexcept;
    LineEvent step_listing() noexcept;
    LineEvent step_configure() noexcept;
    LineEvent step_finish() noexcept;
    LineEvent raise(Alarm alarm) noexcept
    {
        alarm_ = alarm;
        return LineEvent::kAlarm;
    }

    MachineCore& core_;
    CycleControl& cycle_;
    Reports& reports_;
    ProgramActions actions_{core_, cycle_};
    HomingCommand homing_{core_};
    StartupLines startup_{core_.keeper.stored()};
    SystemCommands commands_{core_, actions_, homing_, reports_, startup_};
    Task task_{Task::kNone};
    Ending ending_{Ending::kAnswer};
    Alarm alarm_{Alarm::kNone};
    bool resets_{false};  // the machine, once the line is answered
};

}  // namespace cusp::machine
