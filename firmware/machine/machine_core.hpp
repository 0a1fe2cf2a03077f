// MachineCore: what the parts of a machine work on together.
#pragma once

#include <string_view>

#include "firmware/gcode/interpreter.hpp"
#include "firmware/machine/line_dialogue.hpp"
#include "firmware/machine/listing.hpp"
#include "firmware/machine/motion.hpp"
#include "firmware/machine/output_control.hpp"
#include "firmware/machine/settings_keeper.hpp"
#include "firmware/machine/status_report.hpp"
#include "firmware/machine/system_state.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

// Context: main loop, but for what Motion says of itself.
struct MachineCore {
    //   queue           must outlive this
    //   factory, board  as of SettingsKeeper
    MachineCore(planner::PathQueue& queue,
                const Settings* factory,
                const BoardLimits& board) noexcept
        : keeper{factory, board}, motion{queue, keeper.settings()}
    {
    }
    MachineCore(const MachineCore&) = delete;
    MachineCore& operator=(const MachineCore&) = delete;

    SettingsKeeper keeper;
    Motion motion;
    gcode::Interpreter interpreter;
    protocol::ReplyQueue replies;
    LineDialogue lines{replies};
    StatusReporter reporter;
    OutputControl outputs{motion, interpreter, reporter, keeper.settings()};
    SystemState system;
    ProbeResult last_probe;

    const Settings& settings() const noexcept { return keeper.settings(); }
    bool input_on(InputBit input) const noexcept { return (motion.inputs().steady() & input) != 0; }
    bool limit_on() const noexcept { return (motion.inputs().steady() & kLimitInputs) != 0; }

    // Sends [MSG:text].
    void message(std::string_view text) noexcept
    {
        (void)replies.text("[MSG:").text(text).text("]").end_line();
    }
    // The interpreter continues from the machine's true position.
    void resynchronise() noexcept
    {
        interpreter.discard();
        interpreter.set_position(motion.tail());
    }
    // True if every move is done; otherwise no move follows for now.
    bool wait_settled() noexcept
    {
        const bool settled = motion.settled();
        if (!settled) {
            motion.close();
        }
        return settled;
    }
};

}  // namespace cusp::machine
