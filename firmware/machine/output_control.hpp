// OutputControl: spindle, coolant and drives, and the operator's overrides, as program, operator and
// safety change them.
#pragma once

#include <cstdint>

#include "firmware/base/panel.hpp"
#include "firmware/gcode/interpreter.hpp"
#include "firmware/machine/accessories.hpp"
#include "firmware/machine/motion.hpp"
#include "firmware/machine/overrides.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/machine/status_report.hpp"

namespace cusp::machine {

// Context: main loop.
class OutputControl {
public:
    // All must outlive this.
    OutputControl(Motion& motion,
                  gcode::Interpreter& interpreter,
                  StatusReporter& reporter,
                  const Settings& settings) noexcept
        : motion_{motion}, interpreter_{interpreter}, reporter_{reporter}, settings_{settings}
    {
    }

    const Accessories& accessories() const noexcept { return accessories_; }
    const Overrides& overrides() const noexcept { return overrides_; }
    // rpm: of a laser just now.
    float spindle_speed() const noexcept;
    // `stopped`: the drives are off, whatever $1 says.
    OutputLevels levels(bool stopped) const noexcept;

    // Once a slice: the clocks of what comes up and of the drives. False if the spindle, which says when
    // it is up (setting 797), did not come up in time.
    bool follow() noexcept;

    // A realtime command that may be an override.
    void override_by(protocol::RealtimeCommand command) noexcept;
    void reset_overrides() noexcept;

    // The power of a move, by the S word in force: of the same for each length with M4.
    path::LaserPower laser_power(const path::Move& move) const noexcept;

    // True if the speed alone changes, of a laser: the moves have it, nothing has to stop for it.
    bool changes_with_moves(const gcode::Spindle& spindle) const noexcept
    {
        return settings_.on(Setting::kLaserMode) && spindle.mode == accessories_.spindle;
    }
    // M3, M4 and M5. True if the spindle has to come up to speed: see coming_up().
    bool set_spindle(gcode::SpindleMode mode, float speed) noexcept;
    void set_coolant(bool flood, bool mist) noexcept;
    // The operator's M7, M8 and M9.
    void toggle_coolant(protocol::RealtimeCommand command) noexcept;
    // All off; the interpreter hears of it.
    void switch_off() noexcept;
    // M2 and M30: all off and as programmed.
    void end_program() noexcept;

    // Off for a while: the door is open.
    void pause() noexcept;
    // Brings up again what pause() has paused.
    void restore() noexcept;
    // False if no spindle is on that could be stopped for a while.
    bool can_pause_spindle() const noexcept;
    // True if the spindle is off now; otherwise it comes up. Precondition: can_pause_spindle().
    bool toggle_spindle_pause() noexcept;

    void begin_tool_change() noexcept;
    // Comes up again over the part.
    void end_tool_change() noexcept;

    // Spindle or coolant; nothing moves meanwhile.
    bool coming_up() const noexcept { return coming_up_; }
    // A spindle's drive that is spoken to, where there is one; told what it shall do. `cut`: nothing.
    vfd::Vfd& vfd() noexcept { return vfd_; }
    void tell_vfd(bool cut) noexcept;
    void configure() noexcept { vfd_.configure(settings_.vfd(), settings_.vfd_times()); }

    // Servo tick at which that ends.
    std::uint32_t up_at() const noexcept { return up_at_; }

private:
    void set_overrides() noexcept;
    void wait_until_up(std::uint32_t ticks) noexcept;
    bool waits_for_spindle() const noexcept
    {
        return (settings_.on(Setting::kAtSpeedInput) || settings_.has_vfd()) &&
               accessories_.spindle_on() && !settings_.on(Setting::kLaserMode);
    }
    bool says_at_speed() const noexcept;

    Motion& motion_;
    gcode::Interpreter& interpreter_;
    StatusReporter& reporter_;
    const Settings& settings_;
    Overrides overrides_;
    Accessories accessories_;
    vfd::Vfd vfd_;
    std::uint32_t switched_at_{0};
    std::uint32_t up_at_{0};
    std::uint32_t still_since_{0};  // tick when motion settled last
    bool coming_up_{false};
    bool has_moved_{false};  // since power-up
};

}  // namespace cusp::machine
