// Slides, switches and plate of the virtual machine tool.
#include "hal/sim/simulated_mill.hpp"

namespace cusp::hal {
std::uint16_t SimulatedMill::inputs() const noexcept
{
    unsigned bits = 0;
    const Vec3d at = place();
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        const double beyond = geometry_.switch_distance;
        if (at[axis] >= beyond || at[axis] <= -geometry_.travel[axis] - beyond) {
            bits |= unsigned{kLimitX} << axis;
        }
    }
    if (geometry_.second_motor && geometry_.second_switch) {
        const double second = second_place() - *geometry_.second_switch;
        const double travel = geometry_.travel[*geometry_.second_motor];
        const double beyond = geometry_.switch_distance;
        bits |= second >= beyond || second <= -travel - beyond ? unsigned{kSecondLimit} : 0U;
    }
    if (geometry_.plate_above_start &&
        at.z - geometry_.start.z <= *geometry_.plate_above_start + 1e-9) {
        bits |= kProbe;
    }
    return static_cast<std::uint16_t>((bits | forced_high_) & ~unsigned{forced_low_});
}

void SimulatedMill::set(const OutputLevels& levels) noexcept
{
    if (levels == outputs_) {
        return;
    }
    ++output_changes_;
    outputs_ = levels;
}

void SimulatedMill::frame_played(std::uint64_t /*start_tick*/, const PulseFrame& frame)
{
    for (const PulseEdge& edge : frame.edges) {
        const auto risen = static_cast<PulseLines>(edge.raise & ~unsigned{levels_});
        levels_ = static_cast<PulseLines>((levels_ | edge.raise) & ~unsigned{edge.lower});
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            if ((risen & step_line(axis)) != 0) {
                take_step(axis);
            }
        }
        if ((risen & kSecondStepLine) != 0) {
            take_second_step();
        }
    }
}

void SimulatedMill::set_geometry(const MillGeometry& geometry) { geometry_ = geometry; }

Vec3d SimulatedMill::place() const noexcept
{
    Vec3d at = geometry_.start;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        at[axis] += static_cast<double>(steps_[axis]) / geometry_.steps_per_mm[axis];
    }
    return at;
}

double SimulatedMill::second_place() const noexcept
{
    const unsigned axis = geometry_.second_motor.value_or(0);
    return geometry_.start[axis] + geometry_.second_ahead +
           static_cast<double>(second_steps_) / geometry_.steps_per_mm[axis];
}

void SimulatedMill::take_second_step() noexcept
{
    second_steps_ += (levels_ & kSecondDirectionLine) != 0 ? 1 : -1;
}

void SimulatedMill::take_step(unsigned axis) noexcept
{
    const bool plus = (levels_ & direction_line(axis)) != 0;
    const bool inverted = (geometry_.inverted_directions >> axis & 1U) != 0;
    steps_[axis] += plus != inverted ? 1 : -1;
    ++steps_taken_[axis];
}

}  // namespace cusp::hal
