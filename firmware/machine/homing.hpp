// Homing: finds the switch of each axis and sets the machine position from it.
//
// Each axis in turn, by the passes of $44 to $46: seek the switch fast, pull off, find it again slowly, pull
// off. The machine is then $27, or $850 to $852, inside its travel.
//
// An axis with two motors and two switches is squared during the slow search: both motors run until
// the first switch closes. The other motor continues alone to its switch, then until it is as far
// beyond it as the first ($170 to $172 are added). Both pull off together, so the axis stays square.
// $347 to $349 bound the skew.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/motion.hpp"

namespace cusp::machine {

// Context: main loop.
class Homing {
public:
    // Begins a cycle over these axes, at least one. Precondition: motion.settled().
    void begin(AxisMask axes, const Settings& settings) noexcept;

    enum class Progress : std::uint8_t { kWaiting, kStepped, kFinished, kFailed };

    // Performs the next step, if its conditions hold.
    Progress step(Motion& motion, const Settings& settings) noexcept;

    // Why it failed.
    Alarm alarm() const noexcept { return alarm_; }

private:
    enum class Phase : std::uint8_t {
        kSeek,
        kFirstPullOff,
        kLocate,
        kSquare,  // the motor that lags, to its switch
        kAlign,   // and to where it is level with the other
        kSecondPullOff,
    };

    std::uint16_t switches(const Settings& settings) const noexcept;
    bool closed(const Motion& motion, unsigned inputs) const noexcept
    {
        return (unsigned{motion.inputs().steady()} & inputs) != 0;
    }
    void note_contact(const Motion& motion) noexcept;
    bool start_search(Motion& motion, const Settings& settings) noexcept;
    std::int64_t alignment(const Motion& motion, const Settings& settings) const noexcept;
    bool homes_to_minus(const Settings& settings) const noexcept;
    bool next_axis(const Settings& settings) noexcept;
    Progress start_phase(Motion& motion, const Settings& settings) noexcept;
    void go(Motion& motion, std::int64_t distance, float mm_per_minute) const noexcept;
    Progress finish_search(const Motion& motion, const Settings& settings) noexcept;
    Progress finish_phase(Motion& motion, const Settings& settings) noexcept;
    Progress finish_axis(Motion& motion, const Settings& settings) noexcept;
    Progress fail(Alarm alarm) noexcept;

    AxisMask axes_{};
    unsigned axis_{0};
    Phase phase_{Phase::kSeek};
    bool moving_{false};
    bool resting_{false};
    std::uint32_t rest_until_{0};
    std::int64_t contact_{0};
    // Squaring: the motor whose switch closes later, the position of that switch if it is known, and
    // the position of the other motor.
    Motors lagging_{Motors::kBoth};
    std::optional<std::int64_t> later_contact_;
    std::int64_t other_at_{0};
    Alarm alarm_{Alarm::kNone};
};

}  // namespace cusp::machine
