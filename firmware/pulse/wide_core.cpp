// The steps of all axes at once, for cores that wait for divisions. Apart from pulse_maker.cpp, whose
// calls a compiler for narrow cores is to see alone when it chooses what to put in line.
#include <cstdlib>
#include <limits>
#include <optional>

#include "firmware/pulse/steady_lanes.hpp"
#include "firmware/pulse/step_writer.hpp"

namespace cusp::pulse {

// As play_axis() of one axis after the other: no axis reads what another writes.
void PulseMaker::play_axes(const PerAxis<AxisTravel>& travels) noexcept
{
    struct StepRun {
        StepTimes times;
        StepWriter<decltype(marks_)> writer;
        std::int32_t left;         // steps
        std::int32_t steady_left;  // of these, in its lane
    };
    std::array<std::optional<StepRun>, kAxisCount> runs;
    SteadyLanes lanes;
    bool steady = false;
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
        StepRun& run = runs[i].emplace(StepRun{times, writer, std::abs(path.steps) - 1, 0});
        if (run.left > 1 && times.steady()) {
            run.steady_left = run.left - 1;
            lanes.put(i, times);
            steady = true;
        }
    }
    while (steady) {
        steady = false;
        std::int32_t rounds = std::numeric_limits<std::int32_t>::max();
        for (const auto& run : runs) {
            rounds = run && run->steady_left > 0 ? std::min(rounds, run->steady_left) : rounds;
        }
        for (std::int32_t round = 0; round < rounds; ++round) {
            const SteadyLanes::Times times = lanes.next();
            for (unsigned i = 0; i < kAxisCount; ++i) {
                if (runs[i] && runs[i]->steady_left > 0) {
                    runs[i]->writer.add(to_pulse_tick(times[i]));
                }
            }
        }
        for (unsigned i = 0; i < kAxisCount; ++i) {
            if (runs[i] && runs[i]->steady_left > 0) {
                runs[i]->left -= rounds;
                runs[i]->steady_left -= rounds;
                if (runs[i]->steady_left == 0) {
                    lanes.take(i, runs[i]->times);
                } else {
                    steady = true;
                }
            }
        }
    }
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
