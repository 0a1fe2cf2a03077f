// Counts the servo ticks of each operation by the line that the machine executes.
#include "host_tools/cli/simulated_times.hpp"

#include <algorithm>
#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "host_tools/program_run/program_run.hpp"

namespace cusp::cli {

using dialect::LineSource;
using program_run::ProgramRun;
using program_run::RunOptions;
using program_run::SetPoint;

std::optional<std::vector<double>> simulated_times(const std::string& program,
                                                   const std::vector<std::size_t>& begins,
                                                   const std::function<void(double)>& progress)
{
    constexpr std::uint64_t kBetween = 1 << 16;  // ticks
    std::vector<std::uint32_t> first_lines;      // of all operations but the first
    for (std::size_t k = 1; k < begins.size(); ++k) {
        const auto from = program.begin() + static_cast<std::ptrdiff_t>(begins[k]);
        first_lines.push_back(
            static_cast<std::uint32_t>(1 + std::count(program.begin(), from, '\n')));
    }
    std::vector<std::uint64_t> ticks(begins.size(), 0);
    std::size_t operation = 0;
    RunOptions options;
    options.measures_motion = false;
    options.measures_deviation = false;
    options.sums_edges = false;
    // Set points do not depend on the size of a step, and pulses are a third of a run.
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        constexpr float kFewSteps = 1;  // a millimetre
        options.settings.put(100 + axis, kFewSteps);
    }
    options.set_point = [&](const SetPoint& point) {
        // between moves no line is executed: the previous one counts
        if (point.line != 0) {
            operation = static_cast<std::size_t>(
                std::upper_bound(first_lines.begin(), first_lines.end(), point.line) -
                first_lines.begin());
        }
        ++ticks[operation];
    };
    LineSource source = LineSource::of_text("the program", program);
    ProgramRun run{source, options};
    for (std::uint64_t tick = 1; run.advance(); ++tick) {
        if (tick % kBetween == 0) {
            progress(run.fraction());
        }
    }
    progress(1.0);
    if (!run.result().good()) {
        return std::nullopt;
    }
    std::vector<double> seconds;
    for (const std::uint64_t count : ticks) {
        seconds.push_back(static_cast<double>(count) / kServoTicksPerSecond);
    }
    return seconds;
}

}  // namespace cusp::cli
