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
        for (unsigned steps = risen & kStepLines; steps != 0; steps &= steps - 1) {
            take_step(static_cast<unsigned>(__builtin_ctz(steps)));
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

void SimulatedMill::take_step(unsigned axis) noexcept
{
    const bool plus = (levels_ & direction_line(axis)) != 0;
    const bool inverted = (geometry_.inverted_directions >> axis & 1U) != 0;
    steps_[axis] += plus != inverted ? 1 : -1;
    ++steps_taken_[axis];
}

}  // namespace cusp::hal
