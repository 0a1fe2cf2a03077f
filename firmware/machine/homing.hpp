// Homing: finds the switch of each axis and makes its place known.
//
// Each axis in turn, Z first: seek the switch fast, pull off, find it again slowly, pull off. The
// machine then stands $27 inside its travel.
#pragma once

#include <cstdint>

#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/motion.hpp"

namespace cusp::machine {

// Context: main loop.
class Homing {
public:
    // Begins a cycle over these axes, all where empty. Precondition: motion.settled().
    void begin(AxisMask axes, const Settings& settings) noexcept;

    enum class Progress : std::uint8_t { kWaiting, kStepped, kFinished, kFailed };

    // Goes on where it can.
    Progress step(Motion& motion, const Settings& settings) noexcept;

    // Why it failed.
    Alarm alarm() const noexcept { return alarm_; }

private:
    enum class Phase : std::uint8_t { kSeek, kFirstPullOff, kLocate, kSecondPullOff };

    bool homes_to_minus(const Settings& settings) const noexcept;
    bool next_axis() noexcept;
    void start_phase(Motion& motion, const Settings& settings) noexcept;
    void go(Motion& motion, std::int64_t distance, float mm_per_minute) const noexcept;
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
    Alarm alarm_{Alarm::kNone};
};

}  // namespace cusp::machine
