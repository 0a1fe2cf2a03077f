// SystemCommands: performs the '$' commands, and says what the line still waits for.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/machine/homing_command.hpp"
#include "firmware/machine/program_actions.hpp"
#include "firmware/machine/reports.hpp"
#include "firmware/machine/startup_lines.hpp"
#include "firmware/protocol/system_command.hpp"

namespace cusp::machine {

// What follows a command.
struct CommandOutcome {
    enum class Next : std::uint8_t {
        kAnswer,          // the answer: `error`
        kListing,         // lines of Reports
        kConfigure,       // motion to settle, then the new settings
        kFinish,          // the store, then the answer
        kHome,            // HomingCommand
        kActions,         // a jog, in ProgramActions
        kTryStartupLine,  // StartupLines::text() is executed, then kept
        kCheckedLines,    // the answer, then lines with checksums
        kPlainLines,      // the answer, then lines without them
    };
    Next next{Next::kAnswer};
    std::optional<Error> error;
    bool resets{false};  // the machine, once the line is answered
};

// Context: main loop.
class SystemCommands {
public:
    // All must outlive this.
    SystemCommands(MachineCore& core,
                   ProgramActions& actions,
                   HomingCommand& homing,
                   Reports& reports,
                   StartupLines& startup) noexcept
        : core_{core}, actions_{actions}, homing_{homing}, reports_{reports}, startup_{startup}
    {
    }

    // Performs a line that begins with '$'.
    CommandOutcome perform(std::string_view line) noexcept;

private:
    CommandOutcome perform(const protocol::SystemCommand& command) noexcept;
    CommandOutcome list(Listing listing) noexcept;
    CommandOutcome set_setting(std::uint32_t number, float value) noexcept;
    CommandOutcome restore(bool settings, bool parameters, bool texts) noexcept;
    CommandOutcome toggle_check_mode() noexcept;
    CommandOutcome unlock() noexcept;
    CommandOutcome home(AxisMask axes) noexcept;
    CommandOutcome jog(std::string_view words) noexcept;
    CommandOutcome set_startup_line(const protocol::SystemCommand& command) noexcept;
    CommandOutcome set_build(std::string_view text) noexcept;

    MachineCore& core_;
    ProgramActions& actions_;
    HomingCommand& homing_;
    Reports& reports_;
    StartupLines& startup_;
};

}  // namespace cusp::machine
