// DriveControl: the motors' drives as the settings want them, and what is said of a fault of one.
#pragma once

#include "firmware/drives/drives.hpp"
#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

// Context: main loop.
class DriveControl {
public:
    // Sets the drives that $338 names and the board has wires to.
    void configure(const Settings& settings, const BoardLimits& board) noexcept;

    // Sends what an emergency stop or a motor fault needs: of a drive that has failed, which and how.
    void tell_alarm(Alarm alarm,
                    const Settings& settings,
                    protocol::ReplyQueue& out) const noexcept;

    drives::Drives& drives() noexcept { return drives_; }
    const drives::Drives& drives() const noexcept { return drives_; }

private:
    void tell_fault(const drives::DriveFault& fault,
                    const Settings& settings,
                    protocol::ReplyQueue& out) const noexcept;

    drives::Drives drives_;
};

}  // namespace cusp::machine
