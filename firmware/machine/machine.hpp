// Machine: the controller as its sender sees it, in every state from Idle to Sleep.
//
//   receive(byte) -> realtime bytes act, text waits
//   poll()        -> lines become moves, waits and answers
//   tick()        -> inputs in, one pulse frame out
//   replies()     -> bytes for the sender
//
// A line is answered exactly once, in order. While one waits (for room, for motion to end, for a
// dwell, a probe, homing or the store) no other is read; realtime bytes always act.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/drives/drives.hpp"
#include "firmware/gcode/interpreter.hpp"
#include "firmware/machine/dwell.hpp"
#include "firmware/machine/homing.hpp"
#include "firmware/machine/line_dialogue.hpp"
#include "firmware/machine/listing.hpp"
#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/motion.hpp"
#include "firmware/machine/output_control.hpp"
#include "firmware/machine/settings_log.hpp"
#include "firmware/machine/status_report.hpp"
#include "firmware/machine/stored_state.hpp"
#include "firmware/machine/tool_changer.hpp"
#include "firmware/protocol/reply_queue.hpp"
#include "firmware/protocol/system_command.hpp"

namespace cusp::machine {

// Context: main loop, but for tick().
class Machine {
public:
    //   factory  the settings where the store holds none, and after `$RST=$`; those of Grbl where
    //            it is null. Must outlive the machine.
    //   board    its capabilities: settings beyond them are refused
    Machine(planner::PathQueue& queue,
            const Settings* factory,
            const BoardLimits& board = {}) noexcept;
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    // The stored state. Fill it before start(), write it when wants_store().
    StoredState& stored() noexcept { return stored_; }

    // Sends the banner and runs the startup lines. `loaded` is the state of the store.
    void start(LogState loaded) noexcept;

    // A byte from the sender.
    void receive(std::uint8_t byte) noexcept;
    // Bytes were lost on their way to receive().
    void bytes_lost() noexcept { lines_.bytes_lost(); }

    // The sender's plug was pulled, or its program has ended: $796.
    void sender_left() noexcept;
    // Every line that was received is answered, and every query; a line may have begun.
    bool all_answered() const noexcept;
    // Bytes of text that receive() takes without a loss.
    std::uint32_t room() const noexcept { return lines_.room(); }

    // One slice of work. Returns whether anything was done.
    bool poll() noexcept;

    protocol::ReplyQueue& replies() noexcept { return replies_; }
    OutputLevels outputs() const noexcept;

    // stored() shall be written now; no frame has an edge. Answer with store_done().
    bool wants_store() const noexcept { return store_wanted_; }
    void store_done(bool written) noexcept;

    // A pulse frame was missing during motion: the steps stopped at once.
    void frame_missed() noexcept;

    // A byte that has come and that receive() has not had yet. Context: servo tick.
    void notice(std::uint8_t byte) noexcept { motion_.stops().take_byte(byte, lines_.checked()); }
    // Context: servo tick.
    void tick(std::uint16_t raw_inputs, PulseFrame& frame) noexcept
    {
        motion_.tick(raw_inputs, frame);
    }

    // True if outputs() are cut: see Stops. Context: servo tick.
    bool cuts_outputs() const noexcept { return motion_.stops().cuts_outputs(); }
    bool cuts_drives() const noexcept { return motion_.stops().cuts_drives(); }
    // The duty cycle of a laser in the frame that has begun to play. Context: servo tick, before tick().
    std::uint16_t laser_duty() const noexcept { return motion_.laser().duty(); }

    // The start of a slice, before the link is read.
    void begin_slice() noexcept { stop_bytes_ = motion_.stops().bytes(); }
    // receive() has had all that had come by then.
    void link_empty() noexcept { motion_.stops().read_up_to(stop_bytes_); }
    // The end of a slice, with outputs() in force: the stops that it has handled are let go.
    void end_slice() noexcept;

    // The motors' drives, as far as the board has wires to them: whoever has the wires carries their
    // datagrams. Nothing moves before they are ready().
    drives::Drives& drives() noexcept { return drives_; }
    // The spindle's drive, as far as the board has a line to one, in the same way; told what it shall do just
    // now, which is to stop while a stop is pending.
    vfd::Vfd& told_vfd() noexcept
    {
        outputs_.tell_vfd(cuts_outputs());
        return outputs_.vfd();
    }

    State state() const noexcept { return state_; }
    Alarm alarm() const noexcept { return alarm_; }
    const Settings& settings() const noexcept { return stored_.settings; }
    const Motion& motion() const noexcept { return motion_; }
    // Offsets in force.
    const gcode::Parameters& parameters() const noexcept { return interpreter_.parameters(); }
    // The machine is away from the program's path, for a tool.
    bool changing_tool() const noexcept { return task_ == Task::kToolChange; }
    // No line waits and nothing moves: a program is done once its last byte is read and this holds.
    bool idle() const noexcept;

private:
    // The event that the executed line waits for.
    enum class Task : std::uint8_t {
        kNone,
        kActions,  // steps of G-code
        kDwell,
        kSpindleUp,
        kProbe,
        kHome,
        kToolChange,
        kListing,
        kConfigure,  // motion to settle, then the new settings
        kFinish,     // the store, then the answer
    };
    // The actions after the line.
    enum class Ending : std::uint8_t { kAnswer, kStartupLine, kKeepStartupLine };

    // machine_realtime.cpp
    void act(protocol::RealtimeCommand command) noexcept;
    bool handle_events() noexcept;
    bool watch_panel() noexcept;
    bool watch_link() noexcept;
    bool report_by_itself() noexcept;
    void feed_hold() noexcept;
    void hold_program() noexcept;
    void cycle_start() noexcept;
    bool protect() noexcept;
    void open_door() noexcept;
    void cancel_jog() noexcept;
    void toggle_spindle_stop() noexcept;

    // machine.cpp
    bool step() noexcept;
    void guard_limits() noexcept;
    bool follow_motion() noexcept;
    void follow_hold() noexcept;
    // Stops everything; the line that waits is answered with an error.
    void raise(Alarm alarm) noexcept;
    // As above, but the caller answers.
    void enter_alarm(Alarm alarm) noexcept;
    void drop_all() noexcept;
    void reset() noexcept;
    void say_hello() noexcept;
    void report_status() noexcept;
    bool suspended() const noexcept;
    bool input_on(InputBit input) const noexcept
    {
        return (motion_.inputs().steady() & input) != 0;
    }
    // Inputs that stop everything: an alarm while one is on, or after it was.
    Alarm protector() const noexcept
    {
        const unsigned on = motion_.inputs().steady() | unsigned{motion_.stops().pending()};
        return (on & kEmergencyStop) != 0 ? Alarm::kEmergencyStop
               : (on & kMotorFault) != 0  ? Alarm::kMotorFault
                                          : Alarm::kNone;
    }
    bool limit_on() const noexcept { return (motion_.inputs().steady() & kLimitInputs) != 0; }
    void message(std::string_view text) noexcept;

    // machine_drives.cpp
    void configure_drives() noexcept;
    bool waits_for_drives() const noexcept;
    bool protect_drives() noexcept;
    void tell_drive_fault(const drives::DriveFault& fault) noexcept;
    bool protect_spindle() noexcept;

    // machine_lines.cpp
    bool read_lines() noexcept;
    void execute_text(std::string_view text) noexcept;
    void execute_gcode(std::string_view text, Ending ending) noexcept;
    void finish_line(std::optional<Error> error) noexcept;
    void next_startup_line() noexcept;

    // machine_commands.cpp
    void execute_command(std::string_view text) noexcept;
    void perform(const protocol::SystemCommand& command) noexcept;
    void start_listing(Listing listing) noexcept;
    void set_setting(std::uint32_t number, float value) noexcept;
    void restore(bool settings, bool parameters, bool texts) noexcept;
    void restore_settings() noexcept;
    void toggle_check_mode() noexcept;
    void unlock() noexcept;
    void start_homing(AxisMask axes) noexcept;
    void start_jog(std::string_view words) noexcept;
    void set_startup_line(const protocol::SystemCommand& command) noexcept;
    void set_build(std::string_view text) noexcept;

    // machine_tasks.cpp
    bool step_task() noexcept;
    bool step_actions() noexcept;
    bool perform_action() noexcept;
    bool perform(const path::Move& move) noexcept;
    bool perform(const gcode::Probe& probe) noexcept;
    bool perform(const gcode::Dwell& dwell) noexcept;
    bool perform(const gcode::Spindle& spindle) noexcept;
    bool perform(const gcode::Coolant& coolant) noexcept;
    bool perform(const gcode::ParametersChanged& changed) noexcept;
    bool perform(const gcode::Pause& pause) noexcept;
    bool perform(const gcode::ProgramEnd& end) noexcept;
    bool wait_settled() noexcept;
    bool step_dwell() noexcept;
    bool step_spindle_up() noexcept;
    bool step_probe() noexcept;
    bool step_home() noexcept;
    bool step_listing() noexcept;
    bool step_configure() noexcept;
    bool step_finish() noexcept;
    void resynchronise() noexcept;

    // machine_tool_change.cpp
    gcode::ToolChangeRule tool_change_rule() const noexcept;
    bool perform(const gcode::ToolChange& change) noexcept;
    bool perform(const gcode::RotaryIgnored& ignored) noexcept;
    void start_tool_change(const gcode::ToolChange& change, ToolChangeMode mode) noexcept;
    bool step_tool_change() noexcept;
    void ask_for_tool(unsigned tool) noexcept;
    void take_tool_length() noexcept;

    StoredState stored_;
    const Settings* const factory_;  // may be null
    const BoardLimits board_;
    Motion motion_;
    gcode::Interpreter interpreter_;
    Homing homing_;
    ToolChanger tool_changer_;
    drives::Drives drives_;

    protocol::ReplyQueue replies_;
    LineDialogue lines_{replies_};
    StatusReporter reporter_;
    OutputControl outputs_{motion_, interpreter_, reporter_, stored_.settings};

    State state_{State::kIdle};
    Alarm alarm_{Alarm::kNone};
    bool critical_{false};      // after a limit alarm: only a reset is accepted
    bool reset_needed_{false};  // after an emergency stop: no motion before a reset
    bool locked_{false};        // check mode was entered from an alarm
    bool hold_pending_{false};  // M0: the hold begins once the line is answered
    bool jog_cancelled_{false};
    bool starting_{false};  // a cycle start waits for what comes up

    // Realtime commands that wait for the next slice.
    bool reset_wanted_{false};
    bool status_wanted_{false};
    bool hold_wanted_{false};
    bool start_wanted_{false};
    bool door_wanted_{false};
    bool cancel_wanted_{false};
    bool spindle_stop_wanted_{false};
    bool frame_missed_{false};
    std::uint32_t stop_bytes_{0};
    std::uint32_t reported_at_{0};  // tick

    Task task_{Task::kNone};
    Ending ending_{Ending::kAnswer};
    gcode::Action action_;
    bool action_waits_{false};
    bool jogging_line_{false};
    unsigned startup_next_{kStartupLineCount};
    bool answer_after_startup_{false};
    std::string_view startup_text_;
    std::uint8_t startup_number_{0};
    Dwell dwell_;
    bool probe_alarm_{false};
    AxisMask homing_axes_;
    bool homes_all_{false};
    AxisMask homed_;  // since the position was lost last
    ProbeResult probe_;
    Listing listing_{Listing::kSettings};
    unsigned listing_index_{0};
    bool store_wanted_{false};
    bool store_failed_{false};
    bool reset_after_answer_{false};
    std::uint32_t planner_blocks_{0};
};

}  // namespace cusp::machine
