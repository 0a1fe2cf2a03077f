// Slides, switches and plate of the virtual machine tool.
#include "hal/sim/simulated_mill.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/pulse_frame.hpp"

namespace cusp::hal {
namespace {

// Steps of a frame are counted for all axes in one word: no branch for each edge and axis.
constexpr unsigned kCountBits = 21;
constexpr std::uint64_t kCountMask = (1U << kCountBits) - 1;
static_assert(kPulseTicksPerFrame < kCountMask && kLinearAxes * kCountBits <= 64);
constexpr unsigned kAllAxes = (1U << kLinearAxes) - 1;

// One step of each axis whose bit is set.
constexpr std::array<std::uint64_t, kAllAxes + 1> kStepsOfLines = [] {
    std::array<std::uint64_t, kAllAxes + 1> counts{};
    for (unsigned lines = 0; lines < counts.size(); ++lines) {
        for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
            counts[lines] |= static_cast<std::uint64_t>(lines >> axis & 1U) << kCountBits * axis;
        }
    }
    return counts;
}();

// All counts of the axes whose bit is set.
constexpr std::array<std::uint64_t, kAllAxes + 1> kCountsOfLines = [] {
    std::array<std::uint64_t, kAllAxes + 1> counts{};
    for (unsigned lines = 0; lines < counts.size(); ++lines) {
        counts[lines] = kStepsOfLines[lines] * kCountMask;
    }
    return counts;
}();
constexpr unsigned kDirectionLines =
    direction_line(0) | direction_line(1) | direction_line(2) | kSecondDirectionLine;

}  // namespace

std::uint16_t SimulatedMill::inputs() const noexcept
{
    unsigned bits = 0;
    const Vec3d at = place();
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        const double beyond = geometry_.switch_distance;
        if (at[axis] >= beyond || at[axis] <= -geometry_.travel[axis] - beyond) {
            bits |= unsigned{kLimitX} << axis;
        }
    }
    if (geometry_.second_motor && geometry_.second_switch) {
        const double second = second_place() - *geometry_.second_switch;
        const double travel = geometry_.travel[*geometry_.second_motor];
        const double beyond = geometry_.switch_distance;
        bits |= second >= beyond || second <= -travel - beyond ? unsigned{kFourthLimit} : 0U;
    }
    if (geometry_.rotary) {
        constexpr double kTurn = 360.0;
        const double turned = angle() - kTurn * std::floor(angle() / kTurn);
        bits |= turned < geometry_.rotary->flag ? unsigned{kFourthLimit} : 0U;
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
    if (frame.edges.empty()) {
        return;
    }
    std::uint64_t taken = 0;
    std::uint64_t plus = 0;
    unsigned levels = levels_;
    unsigned changed = 0;
    for (const PulseEdge& edge : frame.edges) {
        taken += kStepsOfLines[edge.raise & ~levels & kAllAxes];
        levels = (levels | edge.raise) & ~unsigned{edge.lower};
        changed |= unsigned{edge.raise} | edge.lower;
    }
    if ((changed & (kDirectionLines | kSecondStepLine)) == 0) {
        // No axis turns: most frames.
        levels_ = static_cast<PulseLines>(levels);
        plus = taken & kCountsOfLines[forward_axes()];
    } else {
        plus = count_steps_forward(frame);
    }
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        const std::uint64_t steps = taken >> kCountBits * axis & kCountMask;
        const std::uint64_t forward = plus >> kCountBits * axis & kCountMask;
        steps_taken_[axis] += steps;
        steps_[axis] += static_cast<std::int64_t>(2 * forward) - static_cast<std::int64_t>(steps);
        if (has_play()) {
            const auto travel = static_cast<double>(2 * forward) - static_cast<double>(steps);
            behind_[axis] = std::clamp(behind_[axis] - travel / geometry_.steps_per_mm[axis], 0.0,
                                       geometry_.play[axis]);
        }
    }
}

unsigned SimulatedMill::forward_axes() const noexcept
{
    return (unsigned{levels_} / direction_line(0) ^ geometry_.inverted_directions) & kAllAxes;
}

// The steps of each axis towards plus; follows the levels and the second motor.
std::uint64_t SimulatedMill::count_steps_forward(const PulseFrame& frame)
{
    std::uint64_t plus = 0;
    for (const PulseEdge& edge : frame.edges) {
        const unsigned risen = edge.raise & ~unsigned{levels_};
        levels_ = static_cast<PulseLines>((levels_ | edge.raise) & ~unsigned{edge.lower});
        plus += kStepsOfLines[risen & forward_axes()];
        if ((risen & kSecondStepLine) != 0) {
            take_second_step();
        }
    }
    return plus;
}

void SimulatedMill::set_geometry(const MillGeometry& geometry) { geometry_ = geometry; }

Vec3d SimulatedMill::place() const noexcept
{
    Vec3d at = geometry_.start;
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        at[axis] +=
            static_cast<double>(steps_[axis]) / geometry_.steps_per_mm[axis] + behind_[axis];
    }
    return at;
}

double SimulatedMill::second_place() const noexcept
{
    const unsigned axis = geometry_.second_motor.value_or(0);
    return geometry_.start[axis] + geometry_.second_ahead +
           static_cast<double>(second_steps_) / geometry_.steps_per_mm[axis];
}

double SimulatedMill::angle() const noexcept
{
    const MillGeometry::RotaryTable& table = *geometry_.rotary;
    return table.start + static_cast<double>(second_steps_) / table.steps_per_degree;
}

void SimulatedMill::take_second_step() noexcept
{
    const int step = (levels_ & kSecondDirectionLine) != 0 ? 1 : -1;
    second_steps_ += step;
    for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
        ++steps_taken_[axis];
        steps_[axis] += step;
    }
}

}  // namespace cusp::hal
