// SimulatedMill: the axes of the virtual machine tool: slides that follow the pulses, limit
// switches at both ends of each travel, a probe plate, buttons, and the spindle's state.
//
// Positions are those of the slides, in millimetres from the upper end of each travel, like Grbl's
// machine space: the table is free to move from -travel to 0. The controller's position may differ;
// homing makes the two agree.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/base/axis.hpp"
#include "firmware/base/vec.hpp"
#include "hal/contract/board.hpp"
#include "hal/sim/simulated_player.hpp"

namespace cusp::hal {

struct MillGeometry {
    Vec3d steps_per_mm{800.0, 800.0, 800.0};
    Vec3d travel{300.0, 200.0, 80.0};
    Vec3d start{-50.0, -30.0, -10.0};
    // A switch trips this far beyond the end of the travel.
    double switch_distance{0.0};
    // Of each screw, mm: a motor that turns about goes so far before its slide follows. At the start they
    // touch on the side that pushes towards plus.
    Vec3d play{0.0, 0.0, 0.0};
    // Height of the probe plate over the place where the tool starts, mm; none: it touches nothing.
    std::optional<double> plate_above_start;
    // Directions whose direction line the drives invert, one bit an axis (setting 3 is applied by
    // the firmware, so it stays 0 unless a wiring fault is wanted).
    std::uint8_t inverted_directions{0};
    // The axis with a second motor; its switch is read as kFourthLimit.
    std::optional<unsigned> second_motor;
    double second_ahead{0.0};  // its lead towards plus at the start, mm
    // Lead of its switches towards plus over those of the first motor, mm; none: it has none.
    std::optional<double> second_switch{0.0};
    // The table that the fourth motor turns, with a flag that closes kFourthLimit from 0 degrees on.
    struct RotaryTable {
        double steps_per_degree{0.0};
        double start{0.0};  // degrees
        double flag{10.0};  // its length, degrees
    };
    std::optional<RotaryTable> rotary;
};

// The contract's Panel; what follows it belongs to the simulation.
class SimulatedMill : public FrameListener {
public:
    explicit SimulatedMill(const MillGeometry& geometry) : geometry_{geometry} {}

    std::uint16_t inputs() const noexcept;
    void set(const OutputLevels& levels) noexcept;
    void set_duty(std::uint16_t pwm) noexcept { outputs_.spindle_pwm = pwm; }

    void frame_played(std::uint64_t start_tick, const PulseFrame& frame) override;

    void set_geometry(const MillGeometry& geometry);

    // Position of the tool, that is of the slides, mm from the upper ends of the travel.
    Vec3d place() const noexcept;
    // Position to which the second motor has moved the slide, on the first one's scale.
    double second_place() const noexcept;
    // Angle of the table, degrees. Precondition: there is one.
    double angle() const noexcept;
    // Steps taken since the start, both ways, and their balance. A has those of the fourth motor.
    const PerAxis<std::uint64_t>& steps_taken() const noexcept { return steps_taken_; }
    const PerAxis<std::int64_t>& steps() const noexcept { return steps_; }
    const OutputLevels& outputs() const noexcept { return outputs_; }
    // Number of calls of set() that changed a level.
    std::uint32_t output_changes() const noexcept { return output_changes_; }

    // Fault injection, or a person at the panel: bits of InputBit that read high, or low, whatever
    // the switches say.
    void force_high(std::uint16_t inputs) noexcept { forced_high_ = inputs; }
    void force_low(std::uint16_t inputs) noexcept { forced_low_ = inputs; }

private:
    unsigned forward_axes() const noexcept;
    std::uint64_t count_steps_forward(const PulseFrame& frame);
    void take_second_step() noexcept;
    bool has_play() const noexcept
    {
        return geometry_.play.x > 0 || geometry_.play.y > 0 || geometry_.play.z > 0;
    }

    MillGeometry geometry_;
    PerAxis<std::int64_t> steps_{};
    Vec3d behind_{};  // of the slides against their motors, mm towards plus, up to the play
    PerAxis<std::uint64_t> steps_taken_{};
    std::int64_t second_steps_{0};
    PulseLines levels_{0};
    OutputLevels outputs_{};
    std::uint32_t output_changes_{0};
    std::uint16_t forced_high_{0};
    std::uint16_t forced_low_{0};
};

}  // namespace cusp::hal
