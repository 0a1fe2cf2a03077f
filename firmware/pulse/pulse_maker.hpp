// Converts set points to pulse frames: every edge of the step and direction lines with its tick.
//
//   PulseMaker maker{settings};
//   maker.reset(position);
//   PulseFrame frame;
//   maker.make_frame(set_point, frame);  // once a servo tick; a HAL plays the frame
//
// Integers only. docs/numerics.md, "Steps", derives the times of the edges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "firmware/base/vec.hpp"
#include "firmware/pulse/edge_marks.hpp"
#include "firmware/pulse/step_times.hpp"

namespace cusp::pulse {

struct StepSettings {
    // Thousandths of a step per millimetre: $100 to $102 have three decimals. In [1, 10 000 000].
    PerAxis<std::uint32_t> millisteps_per_mm{
        of_axes([](unsigned) { return std::uint32_t{800000}; })};
    std::uint16_t pulse_us{2};            // $0: high time, and least low time
    std::uint16_t direction_setup_us{5};  // $29: from a change of direction to the step after it
    // Lines that step with an axis and that say its direction: two each where it has a second motor.
    PerAxis<PulseLines> step_lines{of_axes(step_line)};
    PerAxis<PulseLines> direction_lines{of_axes(direction_line)};
};

// Context: servo tick. Exact: after any number of frames the steps counted are the set point in
// steps, rounded to nearest.
class PulseMaker {
public:
    // Precondition: pulse_us and direction_setup_us in [1, 100].
    explicit PulseMaker(const StepSettings& settings) noexcept { configure(settings); }

    // Precondition: idle().
    void configure(const StepSettings& settings) noexcept;

    // Which of the axis's step lines step from now on. Precondition: idle().
    void set_step_lines(unsigned axis, PulseLines lines) noexcept
    {
        settings_.step_lines[axis] = lines;
    }

    // Sets the position to `at`; makes no edge. Precondition: idle().
    void reset(Position at) noexcept;

    // Takes the set point at the end of the next tick and makes the frame of that tick, which looks
    // at earlier set points alone. A set point again is a stop at once: the frame has what the one
    // before left over.
    void make_frame(Position set_point, PulseFrame& frame) noexcept;

    // After frames that were made and not played: nothing of them follows, all step lines are low, and what
    // the direction lines say is unknown. The position is `at` from now on.
    void lose_frames(Position at) noexcept;

    // True if all lines are low and the last set points are played.
    bool idle() const noexcept;

    // All steps come this much later, so that a direction can be set before the first of a tick.
    std::uint16_t delay_us() const noexcept { return settings_.direction_setup_us; }

    PerAxis<std::int32_t> position_steps() const noexcept;

private:
    struct AxisState {
        std::int64_t set_point{};  // the latest, 1e-9 steps
        std::int32_t remainder{};  // of it, in [-5e8, 5e8)
        std::int32_t steps{};
        std::int32_t last_rise{};  // pulse ticks from the start of the frame, <= 0
        bool forward{false};
        bool direction_known{false};
        TickTravels travels{};
    };
    // The motion of an axis in the tick whose frame is made.
    struct AxisTravel {
        TickCubic cubic;
        std::int32_t steps;
    };
    AxisTravel travel(unsigned axis, std::int64_t nanometres) noexcept;
    void play_axis(unsigned axis, std::int64_t nanometres) noexcept;
    void play_axes(const PerAxis<AxisTravel>& travels) noexcept;
    void add_steps(unsigned axis, StepTimes times, std::int32_t steps) noexcept;
    void end_steps(AxisState& axis, std::int32_t last_rise) noexcept
    {
        axis.last_rise = last_rise;
        const std::int32_t last_fall = last_rise + settings_.pulse_us;
        const auto end = static_cast<std::uint32_t>(last_fall) + 1;
        edges_end_ = end > edges_end_ ? end : edges_end_;
    }
    void turn(unsigned axis, std::int32_t rise, bool forward) noexcept;
    void take_edges(std::uint32_t end, PulseFrame& frame) noexcept;
    void compress(PulseFrame& frame) noexcept;

    // Processors with registers of 64 bits wait for a division longer than for all else: there the
    // steps of all axes are made at once, and the ticks that have edges are marked.
    static constexpr bool kWideCore = sizeof(std::size_t) == 8;

    // Edges of the frame being made and the beginning of the next: raised lines in the low byte,
    // lowered ones in the high byte.
    static constexpr std::size_t kOverhang = 512;
    StepSettings settings_{};
    PerAxis<AxisState> axes_{};
    alignas(std::uint32_t) std::array<std::uint16_t, kPulseTicksPerFrame + kOverhang> edges_{};
    std::uint32_t edges_end_{0};  // beyond the last edge that is set
    EdgeMarks<kWideCore, kPulseTicksPerFrame + kOverhang> marks_;
};

}  // namespace cusp::pulse
