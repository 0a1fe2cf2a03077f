// Steps of three axes, merged into one list of edges a tick.
#include "firmware/pulse/pulse_maker.hpp"

#include <algorithm>

#include "firmware/base/assert.hpp"
#include "firmware/pulse/step_times.hpp"

namespace cusp::pulse {
namespace {

constexpr std::int32_t kStep = 1'000'000'000;  // of the unit of AxisState
constexpr std::int32_t kFrame = static_cast<std::int32_t>(kPulseTicksPerFrame);
constexpr std::int32_t kLongAgo = -100000;

// A whole number of steps nearest to `position`, and what is left in [-kStep/2, kStep/2).
struct Split {
    std::int32_t steps;
    std::int32_t remainder;
};

Split split(std::int64_t position) noexcept
{
    // The float is within one step of the quotient; the loops mend it.
    auto steps = static_cast<std::int32_t>(static_cast<float>(position) * 1e-9F);
    std::int64_t left = position - static_cast<std::int64_t>(steps) * kStep;
    while (left >= kStep / 2) {
        left -= kStep;
        ++steps;
    }
    while (left < -kStep / 2) {
        left += kStep;
        --steps;
    }
    return {steps, static_cast<std::int32_t>(left)};
}

float in_steps(std::int64_t value) noexcept { return static_cast<float>(value) * 1e-9F; }

}  // namespace

void PulseMaker::configure(const StepSettings& settings) noexcept
{
    CUSP_ASSERT(settings.pulse_us >= 1 && settings.pulse_us <= 100);
    CUSP_ASSERT(settings.direction_setup_us >= 1 && settings.direction_setup_us <= 100);
    settings_ = settings;
}

void PulseMaker::reset(Position at) noexcept
{
    for (unsigned i = 0; i < kAxisCount; ++i) {
        AxisState& axis = axes_[i];
        const bool forward = axis.forward;
        const bool known = axis.direction_known;
        axis = AxisState{};
        axis.forward = forward;
        axis.direction_known = known;
        axis.set_point = at[i] * static_cast<std::int64_t>(settings_.millisteps_per_mm[i]);
        // Machine travel may be metres: exact, not by float.
        const std::int64_t whole = axis.set_point / kStep;
        const Split rest = split(axis.set_point - whole * kStep);
        axis.steps = static_cast<std::int32_t>(whole) + rest.steps;
        axis.remainder = rest.remainder;
        axis.last_rise = kLongAgo;
    }
}

bool PulseMaker::idle() const noexcept
{
    const auto still = [](const AxisState& axis) {
        return axis.next == 0 && axis.now == 0;
    };
    return std::all_of(axes_.begin(), axes_.end(), still) && edges_end_ == 0;
}

PerAxis<std::int32_t> PulseMaker::position_steps() const noexcept
{
    return {axes_[0].steps, axes_[1].steps, axes_[2].steps};
}

void PulseMaker::make_frame(Position set_point, PulseFrame& frame) noexcept
{
    for (unsigned i = 0; i < kAxisCount; ++i) {
        AxisState& axis = axes_[i];
        const std::int64_t before = axis.now;
        const std::int64_t target =
            set_point[i] * static_cast<std::int64_t>(settings_.millisteps_per_mm[i]);
        axis.now = axis.next;
        axis.next = target - axis.set_point;
        axis.set_point = target;
        play_axis(i, before);
    }
    compress(frame);
}

void PulseMaker::play_axis(unsigned index, std::int64_t before) noexcept
{
    AxisState& axis = axes_[index];
    if (axis.now == 0) {
        return;
    }
    const Split end = split(axis.remainder + axis.now);
    const TickCubic cubic = tick_cubic(in_steps(axis.remainder), in_steps(before),
                                       in_steps(axis.now), in_steps(axis.next));
    const bool forward = end.steps > 0;
    const std::int32_t count = forward ? end.steps : -end.steps;
    const float bend = sharpest_bend(cubic);
    const float one_step = forward ? 1.0F : -1.0F;
    float level = 0.5F * one_step;
    float time = 0;
    for (std::int32_t k = 0; k < count; ++k) {
        if (!take_newton_step(cubic, bend, level, time)) {
            time = crossing_time(cubic, level, time, forward);
        }
        const auto rise = static_cast<std::int32_t>(time * static_cast<float>(kFrame) + 0.5F);
        if (k == 0) {
            turn(index, rise, forward);
        }
        add_step(index, rise);
        level += one_step;
    }
    axis.steps += end.steps;
    axis.remainder = end.remainder;
    if (count > 0) {
        const std::int32_t last_fall = axis.last_rise + settings_.pulse_us;
        edges_end_ = std::max(edges_end_, static_cast<std::uint32_t>(last_fall) + 1);
    }
}

void PulseMaker::turn(unsigned index, std::int32_t rise, bool forward) noexcept
{
    AxisState& axis = axes_[index];
    if (axis.direction_known && forward == axis.forward) {
        return;
    }
    const std::int32_t pulse = settings_.pulse_us;
    // The step comes a set-up time after its crossing in any case: that is when the line turns,
    // but not before the pulse that goes the other way has ended, and the step after it waits.
    const std::int32_t change = std::max(rise, axis.last_rise + pulse);
    const auto line = static_cast<std::uint16_t>(direction_line(index));
    CUSP_ASSERT(static_cast<std::size_t>(change) < edges_.size());
    edges_[static_cast<std::size_t>(change)] |=
        static_cast<std::uint16_t>(forward ? line : line << 8U);
    axis.last_rise = std::max(axis.last_rise, change + settings_.direction_setup_us - 2 * pulse);
    axis.forward = forward;
    axis.direction_known = true;
}

inline void PulseMaker::add_step(unsigned index, std::int32_t rise) noexcept
{
    AxisState& axis = axes_[index];
    const std::int32_t pulse = settings_.pulse_us;
    rise = std::max(rise + settings_.direction_setup_us, axis.last_rise + 2 * pulse);
    CUSP_ASSERT(static_cast<std::size_t>(rise + pulse) < edges_.size());
    const auto line = static_cast<std::uint16_t>(step_line(index));
    edges_[static_cast<std::size_t>(rise)] |= line;
    edges_[static_cast<std::size_t>(rise + pulse)] |= static_cast<std::uint16_t>(line << 8U);
    axis.last_rise = rise;
}

void PulseMaker::compress(PulseFrame& frame) noexcept
{
    frame.edges.clear();
    const std::uint32_t end = std::min(edges_end_, kPulseTicksPerFrame);
    // Two ticks at a time: most have no edge.
    for (std::uint32_t pair = 0; pair < end; pair += 2) {
        std::uint32_t both = 0;
        __builtin_memcpy(&both, &edges_[pair], sizeof both);
        if (both == 0) {
            continue;
        }
        for (std::uint32_t tick = pair; tick < pair + 2; ++tick) {
            const std::uint16_t edge = edges_[tick];
            if (edge != 0) {
                (void)frame.edges.try_push_back({static_cast<std::uint16_t>(tick),
                                                 static_cast<PulseLines>(edge & 0xFFU),
                                                 static_cast<PulseLines>(edge >> 8U)});
                edges_[tick] = 0;
            }
        }
    }
    const std::uint32_t left = edges_end_ - end;
    for (std::uint32_t i = 0; i < left; ++i) {
        edges_[i] = edges_[kPulseTicksPerFrame + i];
        edges_[kPulseTicksPerFrame + i] = 0;
    }
    edges_end_ = left;
    for (AxisState& axis : axes_) {
        axis.last_rise = std::max(axis.last_rise - kFrame, kLongAgo);
    }
}

}  // namespace cusp::pulse
