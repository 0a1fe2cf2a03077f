// Steps of three axes, merged into one list of edges a tick.
#include "firmware/pulse/pulse_maker.hpp"

#include <algorithm>

#include "firmware/base/assert.hpp"
#include "firmware/pulse/step_times.hpp"
#include "firmware/pulse/step_writer.hpp"

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

// Writes an edge as one word. `lines`: raised ones in the low byte, lowered ones in the high byte.
void put_edge(PulseEdge* out, std::uint32_t tick, std::uint32_t lines) noexcept
{
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
    static_assert(sizeof(PulseEdge) == sizeof(std::uint32_t) && offsetof(PulseEdge, tick) == 0 &&
                  offsetof(PulseEdge, raise) == 2 && offsetof(PulseEdge, lower) == 3);
    const std::uint32_t edge = tick | lines << 16U;
    __builtin_memcpy(out, &edge, sizeof edge);
}

}  // namespace

void PulseMaker::configure(const StepSettings& settings) noexcept
{
    CUSP_ASSERT(settings.pulse_us >= 1 && settings.pulse_us <= 100);
    CUSP_ASSERT(settings.direction_setup_us >= 1 && settings.direction_setup_us <= 100);
    // The direction of a line that is new to the axis is not known.
    for (unsigned i = 0; i < kAxisCount; ++i) {
        if (settings.direction_lines[i] != settings_.direction_lines[i]) {
            axes_[i].direction_known = false;
        }
    }
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
        return axis.travels.now == 0;
    };
    return std::all_of(axes_.begin(), axes_.end(), still) && edges_end_ == 0;
}

PerAxis<std::int32_t> PulseMaker::position_steps() const noexcept
{
    PerAxis<std::int32_t> steps{};
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        steps[axis] = axes_[axis].steps;
    }
    return steps;
}

void PulseMaker::make_frame(Position set_point, PulseFrame& frame) noexcept
{
    if constexpr (kWideCore) {
        PerAxis<AxisTravel> travels{};
        for (unsigned i = 0; i < kAxisCount; ++i) {
            travels[i] = travel(i, set_point[i]);
        }
        play_axes(travels);
    } else {
        for (unsigned i = 0; i < kAxisCount; ++i) {
            play_axis(i, set_point[i]);
        }
    }
    compress(frame);
}

void PulseMaker::lose_frames(Position at) noexcept
{
    edges_.fill(0);
    edges_end_ = 0;
    marks_ = {};
    reset(at);
    for (AxisState& axis : axes_) {
        axis.direction_known = false;
    }
}

// The path of an axis in the tick to its set point, and its steps, which its state counts.
inline PulseMaker::AxisTravel PulseMaker::travel(unsigned index, std::int64_t nanometres) noexcept
{
    AxisState& axis = axes_[index];
    const std::int64_t target =
        nanometres * static_cast<std::int64_t>(settings_.millisteps_per_mm[index]);
    const std::int64_t way = target - axis.set_point;
    axis.set_point = target;
    axis.travels.add(in_steps(way));
    if (way == 0) {
        return {};
    }
    const Split end = split(axis.remainder + way);
    const TickCubic cubic = axis.travels.cubic_from(in_steps(axis.remainder));
    axis.steps += end.steps;
    axis.remainder = end.remainder;
    return {cubic, end.steps};
}

void PulseMaker::play_axis(unsigned index, std::int64_t nanometres) noexcept
{
    const AxisTravel path = travel(index, nanometres);
    if (path.steps != 0) {
        add_steps(index, StepTimes{path.cubic, path.steps > 0}, path.steps);
    }
}

// One call a tick and axis; what it does for each step is most of the firmware's work at high
// rates.
void PulseMaker::add_steps(unsigned index, StepTimes times, std::int32_t steps) noexcept
{
    AxisState& axis = axes_[index];
    const bool forward = steps > 0;
    const std::int32_t count = forward ? steps : -steps;
    const std::int32_t first = to_pulse_tick(times.next());
    turn(index, first, forward);
    StepWriter writer{edges_, marks_, settings_, settings_.step_lines[index], axis.last_rise};
    writer.add(first);
    std::int32_t done = 1;
    if (times.steady()) {
        for (; done < count - 1; ++done) {
            writer.add(to_pulse_tick(times.next_steady()));
        }
    }
    for (; done < count; ++done) {
        writer.add(to_pulse_tick(times.next()));
    }
    end_steps(axis, writer.last_rise());
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
    const auto line = static_cast<std::uint16_t>(settings_.direction_lines[index]);
    CUSP_ASSERT(static_cast<std::size_t>(change) < edges_.size());
    edges_[static_cast<std::size_t>(change)] |=
        static_cast<std::uint16_t>(forward ? line : line << 8U);
    marks_.mark(change);
    axis.last_rise = std::max(axis.last_rise, change + settings_.direction_setup_us - 2 * pulse);
    axis.forward = forward;
    axis.direction_known = true;
}

// Moves the edges before `end` into the frame.
inline void PulseMaker::take_edges(std::uint32_t end, PulseFrame& frame) noexcept
{
    // Written past the vector's size, which is set at the end: no count is kept in memory.
    PulseEdge* const first = frame.edges.begin();
    PulseEdge* out = first;
    if constexpr (kWideCore) {
        marks_.take(end, [&](std::uint32_t tick) {
            put_edge(out++, tick, edges_[tick]);
            edges_[tick] = 0;
        });
    } else {
        // A word at a time, the earlier tick in its lower half: most words have no edge.
        static_assert(kPulseTicksPerFrame % 2 == 0);
        for (std::uint32_t tick = 0; tick < end; tick += 2) {
            std::uint32_t word = 0;
            __builtin_memcpy(&word, &edges_[tick], sizeof word);
            if (word == 0) {
                continue;
            }
            __builtin_memset(&edges_[tick], 0, sizeof word);
            if ((word & 0xFFFFU) != 0) {
                put_edge(out++, tick, word & 0xFFFFU);
            }
            if (word >> 16U != 0) {
                put_edge(out++, tick + 1, word >> 16U);
            }
        }
    }
    frame.edges.grow(static_cast<std::size_t>(out - first));
}

// In line in each frame, as if cut() did not call it, too.
[[gnu::always_inline]] inline void PulseMaker::compress(PulseFrame& frame) noexcept
{
    frame.edges.clear();
    if (edges_end_ != 0) {
        const std::uint32_t end = std::min(edges_end_, kPulseTicksPerFrame);
        take_edges(end, frame);
        const std::uint32_t left = edges_end_ - end;
        for (std::uint32_t i = 0; i < left; ++i) {
            edges_[i] = edges_[kPulseTicksPerFrame + i];
            edges_[kPulseTicksPerFrame + i] = 0;
        }
        edges_end_ = left;
    }
    for (AxisState& axis : axes_) {
        axis.last_rise = std::max(axis.last_rise - kFrame, kLongAgo);
    }
}

}  // namespace cusp::pulse
