// ProbeCommand: G38.2 to G38.5: a move that ends at the probe's contact.
#pragma once

#include "firmware/machine/action_progress.hpp"
#include "firmware/machine/machine_core.hpp"

namespace cusp::machine {

// Context: main loop.
class ProbeCommand {
public:
    // `core` must outlive this.
    explicit ProbeCommand(MachineCore& core) noexcept : core_{core} {}

    // Starts the move: kDone, then step(). kLineOver and kAlarm: see alarm(); nothing moves.
    ActionProgress begin(const gcode::Probe& probe) noexcept;
    // kWaits, or kLineOver: the result is in core.last_probe, and tell() sends it.
    ActionProgress step() noexcept;

    // The alarm that the line ends in: kProbeInitial, kProbeContact, kSoftLimit, or kNone.
    Alarm alarm() const noexcept { return alarm_; }
    // Sends [PRB:...] of a move that has ended. Once.
    void tell() noexcept;

private:
    MachineCore& core_;
    Alarm alarm_{Alarm::kNone};
    bool needs_contact_{false};
    bool has_moved_{false};
};

}  // namespace cusp::machine
