// The steps of all axes at once, for cores that wait for divisions. Apart from pulse_maker.cpp, whose
// calls a compiler for narrow cores is to see alone when it chooses what to put in line.
#include <algorithm>
#include <optional>

#include "firmware/pulse/steady_lanes.hpp"
#include "firmware/pulse/step_writer.hpp"

namespace cusp::pulse {
namespace {

// The steps of one axis in a frame.
template <class Writer>
struct StepRun {
    StepTimes times;
    Writer writer;
    std::int32_t left;         // steps
    std::int32_t steady_left;  // of these
};

// As many steady steps of the first kCount runs. The count is known and the writers are copies, so
// that both stay in registers.
template <unsigned kCount, class Run>
void add_steady(const std::array<Run*, kAxisCount>& runs, std::int32_t steps) noexcept
{
    SteadyLanes lanes;
    for (unsigned lane = 0; lane < kCount; ++lane) {
        lanes.put(lane, runs[lane]->times);
    }
    auto first = runs[0]->writer;
    auto second = runs[kCount > 1 ? 1 : 0]->writer;
    auto third = runs[kCount > 2 ? 2 : 0]->writer;
    auto fourth = runs[kCount > 3 ? 3 : 0]->writer;
    const auto add = [&](const SteadyLanes::Ticks& ticks) {
        first.add(ticks[0]);
        if constexpr (kCount > 1) {
            second.add(ticks[1]);
        }
        if constexpr (kCount > 2) {
            third.add(ticks[2]);
        }
        if constexpr (kCount > 3) {
            fourth.add(ticks[3]);
        }
    };
    if (lanes.even()) {
        for (std::int32_t step = 0; step < steps; ++step) {
            add(lanes.next_even());
        }
    } else {
        for (std::int32_t step = 0; step < steps; ++step) {
            add(lanes.next());
        }
    }
    runs[0]->writer = first;
    if constexpr (kCount > 1) {
        runs[1]->writer = second;
    }
    if constexpr (kCount > 2) {
        runs[2]->writer = third;
    }
    if constexpr (kCount > 3) {
        runs[3]->writer = fourth;
    }
    for (unsigned lane = 0; lane < kCount; ++lane) {
        lanes.take(lane, runs[lane]->times);
        runs[lane]->left -= steps;
        runs[lane]->steady_left -= steps;
    }
}

// The steady steps of all runs: together until one has no more, then those that are left.
template <class Run>
void add_all_steady(std::array<std::optional<Run>, kAxisCount>& runs) noexcept
{
    for (;;) {
        std::array<Run*, kAxisCount> together{};
        unsigned count = 0;
        std::int32_t steps = 0;
        for (std::optional<Run>& run : runs) {
            if (run && run->steady_left > 0) {
                steps = count == 0 ? run->steady_left : std::min(steps, run->steady_left);
                together[count++] = &*run;
            }
        }
        if (count == 0) {
            return;
        }
        count == 1   ? add_steady<1>(together, steps)
        : count == 2 ? add_steady<2>(together, steps)
        : count == 3 ? add_steady<3>(together, steps)
                     : add_steady<kAxisCount>(together, steps);
    }
}

}  // namespace

// As play_axis() of one axis after the other: no axis reads what another writes.
void PulseMaker::play_axes(const PerAxis<AxisTravel>& travels) noexcept
{
    std::array<std::optional<StepRun<StepWriter<decltype(marks_)>>>, kAxisCount> runs;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const AxisTravel& path = travels[i];
        if (path.steps == 0) {
            continue;
        }
        const bool forward = path.steps > 0;
        StepTimes times{path.cubic, forward};
        const std::int32_t first = to_pulse_tick(times.next());
        turn(i, first, forward);
        StepWriter writer{edges_, marks_, settings_, settings_.step_lines[i], axes_[i].last_rise};
        writer.add(first);
        const std::int32_t left = (forward ? path.steps : -path.steps) - 1;
        runs[i].emplace(
            StepRun<decltype(writer)>{times, writer, left, times.steady() ? left - 1 : 0});
    }
    add_all_steady(runs);
    for (unsigned i = 0; i < kAxisCount; ++i) {
        if (runs[i]) {
            for (; runs[i]->left > 0; --runs[i]->left) {
                runs[i]->writer.add(to_pulse_tick(runs[i]->times.next()));
            }
            end_steps(axes_[i], runs[i]->writer.last_rise());
        }
    }
}

}  // namespace cusp::pulse
