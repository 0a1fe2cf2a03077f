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
    return std::all_of(axes_.begin(), axes_.end(), still) && !overhang_used_;
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
    const float direction = forward ? 1.0F : -1.0F;
    float time = 0;
    for (std::int32_t k = 0; k < count; ++k) {
        const float level = direction * (static_cast<float>(k) + 0.5F);
        time = crossing_time(cubic, level, time, forward);
        add_step(index, static_cast<std::int32_t>(time * static_cast<float>(kFrame) + 0.5F),
                 forward);
    }
    axis.steps += end.steps;
    axis.remainder = end.remainder;
}

void PulseMaker::add_step(unsigned index, std::int32_t rise, bool forward) noexcept
{
    AxisState& axis = axes_[index];
    const std::int32_t pulse = settings_.pulse_us;
    const std::int32_t setup = settings_.direction_setup_us;
    rise = std::max(rise + setup, axis.last_rise + 2 * pulse);
    if (!axis.direction_known || forward != axis.forward) {
        // Not before the pulse that goes the other way has ended.
        rise = std::max(rise, axis.last_rise + pulse + setup);
        const auto line = static_cast<std::uint16_t>(direction_line(index));
        edges_[static_cast<std::size_t>(rise - setup)] |=
            static_cast<std::uint16_t>(forward ? line : line << 8U);
        axis.forward = forward;
        axis.direction_known = true;
    }
    CUSP_ASSERT(static_cast<std::size_t>(rise + pulse) < edges_.size());
    const auto line = static_cast<std::uint16_t>(step_line(index));
    edges_[static_cast<std::size_t>(rise)] |= line;
    edges_[static_cast<std::size_t>(rise + pulse)] |= static_cast<std::uint16_t>(line << 8U);
    axis.last_rise = rise;
}

void PulseMaker::compress(PulseFrame& frame) noexcept
{
    frame.edges.clear();
    for (std::uint32_t tick = 0; tick < kPulseTicksPerFrame; ++tick) {
        const std::uint16_t edge = edges_[tick];
        if (edge != 0) {
            (void)frame.edges.try_push_back({static_cast<std::uint16_t>(tick),
                                             static_cast<PulseLines>(edge & 0xFFU),
                                             static_cast<PulseLines>(edge >> 8U)});
            edges_[tick] = 0;
        }
    }
    overhang_used_ = false;
    for (std::size_t i = 0; i < kOverhang; ++i) {
        std::uint16_t& late = edges_[kPulseTicksPerFrame + i];
        if (late != 0) {
            edges_[i] = late;
            late = 0;
            overhang_used_ = true;
        }
    }
    for (AxisState& axis : axes_) {
        axis.last_rise = std::max(axis.last_rise - kFrame, kLongAgo);
    }
}

}  // namespace cusp::pulse
