// Machine: the controller as its sender sees it, in every state from Idle to Sleep.
//
//   receive(byte) -> realtime bytes act, text waits
//   poll()        -> lines become moves, waits and answers
//   tick()        -> inputs in, one pulse frame out
//   replies()     -> bytes for the sender
//
// It is made of parts, which share a MachineCore: RealtimeRequests (what was asked for), CycleControl
// (holds, starts, the door), LineExecution (a line, with ProgramActions for G-code and SystemCommands
// for '$'), Reports, DriveControl. Machine itself orders them slice by slice, and raises the alarms.
//
// A line is answered exactly once, in order. While one waits (for room, for motion to end, for a
// dwell, a probe, homing or the store) no other is read; realtime bytes always act.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/machine/cycle_control.hpp"
#include "firmware/machine/drive_control.hpp"
#include "firmware/machine/line_execution.hpp"
#include "firmware/machine/machine_core.hpp"
#include "firmware/machine/realtime_requests.hpp"
#include "firmware/machine/reports.hpp"
#include "firmware/machine/settings_log.hpp"

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
    StoredState& stored() noexcept { return core_.keeper.stored(); }

    // Sends the banner and runs the startup lines. `loaded` is the state of the store.
    void start(LogState loaded) noexcept;

    // A byte from the sender.
    void receive(std::uint8_t byte) noexcept;
    // Bytes were lost on their way to receive().
    void bytes_lost() noexcept { core_.lines.bytes_lost(); }

    // The sender's plug was pulled, or its program has ended: $796.
    void sender_left() noexcept;
    // Every line that was received is answered, and every query; a line may have begun.
    bool all_answered() const noexcept;
    // Bytes of text that receive() takes without a loss.
    std::uint32_t room() const noexcept { return core_.lines.room(); }

    // One slice of work. Returns whether anything was done.
    bool poll() noexcept;

    protocol::ReplyQueue& replies() noexcept { return core_.replies; }
    OutputLevels outputs() const noexcept;

    // stored() shall be written now; no frame has an edge. Answer with store_done().
    bool wants_store() const noexcept { return core_.keeper.wants_store(); }
    void store_done(bool written) noexcept;

    // A pulse frame was missing during motion: the steps stopped at once.
    void frame_missed() noexcept;

    // A byte that has come and that receive() has not had yet. Context: servo tick.
    void notice(std::uint8_t byte) noexcept
    {
        core_.motion.stops().take_byte(byte, core_.lines.checked());
    }
    // Context: servo tick.
    void tick(std::uint16_t raw_inputs, PulseFrame& frame) noexcept
    {
        core_.motion.tick(raw_inputs, frame);
    }

    // True if outputs() are cut: see Stops. Context: servo tick.
    bool cuts_outputs() const noexcept { return core_.motion.stops().cuts_outputs(); }
    bool cuts_drives() const noexcept { return core_.motion.stops().cuts_drives(); }
    // The duty cycle of a laser in the frame that has begun to play. Context: servo tick, before tick().
    std::uint16_t laser_duty() const noexcept { return core_.motion.laser().duty(); }

    // The start of a slice, before the link is read.
    void begin_slice() noexcept { stop_bytes_ = core_.motion.stops().bytes(); }
    // receive() has had all that had come by then.
    void link_empty() noexcept { core_.motion.stops().read_up_to(stop_bytes_); }
    // The end of a slice, with outputs() in force: the stops that it has handled are let go.
    void end_slice() noexcept;

    // The motors' drives, as far as the board has wires to them: whoever has the wires carries their
    // datagrams. Nothing moves before they are ready().
    drives::Drives& drives() noexcept { return drives_.drives(); }
    // The spindle's drive, as far as the board has a line to one, in the same way; told what it shall do just
    // now, which is to stop while a stop is pending.
    vfd::Vfd& told_vfd() noexcept
    {
        core_.outputs.tell_vfd(cuts_outputs());
        return core_.outputs.vfd();
    }

    State state() const noexcept { return core_.system.state(); }
    Alarm alarm() const noexcept { return core_.system.alarm(); }
    const Settings& settings() const noexcept { return core_.settings(); }
    const Motion& motion() const noexcept { return core_.motion; }
    // Offsets in force.
    const gcode::Parameters& parameters() const noexcept { return core_.interpreter.parameters(); }
    // The machine is away from the program's path, for a tool.
    bool changing_tool() const noexcept { return line_.changing_tool(); }
    // No line waits and nothing moves: a program is done once its last byte is read and this holds.
    bool idle() const noexcept;

private:
    // machine_realtime.cpp
    void act(protocol::RealtimeCommand command) noexcept;
    bool handle_events() noexcept;
    bool handle_requests() noexcept;
    bool protect() noexcept;
    bool protect_drives() noexcept;
    bool protect_spindle() noexcept;
    bool watch_panel() noexcept;
    bool watch_link() noexcept;
    void feed_hold() noexcept;
    void open_door() noexcept;
    void cancel_jog() noexcept;

    // machine.cpp
    bool step() noexcept;
    bool step_line() noexcept;
    void guard_limits() noexcept;
    bool follow_motion() noexcept;
    // Settings in force, and what follows from them in the interpreter.
    void configure() noexcept;
    // Stops everything; the line that waits is answered with an error.
    void raise(Alarm alarm) noexcept;
    // As above, but the caller answers.
    void enter_alarm(Alarm alarm) noexcept;
    void drop_all() noexcept;
    void reset() noexcept;
    void say_hello() noexcept;

    MachineCore core_;
    RealtimeRequests requests_;
    DriveControl drives_;
    CycleControl cycle_{core_};
    Reports reports_{core_, cycle_};
    LineExecution line_{core_, cycle_, reports_};
    std::uint32_t stop_bytes_{0};
};

}  // namespace cusp::machine
