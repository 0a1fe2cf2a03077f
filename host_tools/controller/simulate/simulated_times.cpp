// Counts the servo ticks of each operation by the line that the machine executes.
#include "host_tools/controller/simulate/simulated_times.hpp"

#include <algorithm>
#include <cstdint>
#include <mutex>

#include "firmware/base/axis.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/controller/program_run/program_run.hpp"
#include "host_tools/controller/simulate/program_parts.hpp"

namespace cusp::simulate {

using dialect::LineSource;
using program_run::ProgramRun;
using program_run::RunOptions;

namespace {

RunOptions options_for_times(const machine::Settings& settings)
{
    RunOptions options;
    options.settings = settings;
    options.measures_motion = false;
    options.measures_deviation = false;
    options.sums_edges = false;
    // Set points do not depend on the size of a step, and pulses are a third of a run.
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        constexpr float kFewSteps = 1;  // a millimetre
        options.settings.put(100 + axis, kFewSteps);
    }
    return options;
}

// Servo ticks of each operation.
using Ticks = std::vector<std::uint64_t>;

// The ticks on the counted lines of one part.
class PartTicks {
public:
    //   first_lines  of all operations but the first
    PartTicks(const ProgramPart& part, const std::vector<std::uint32_t>& first_lines)
        : part_{part}, first_lines_{first_lines}, ticks_(first_lines.size() + 1, 0)
    {
    }

    void add(std::uint32_t line_of_part)
    {
        // between moves no line is executed: the previous one counts
        if (line_of_part != 0 && line_of_part != line_of_part_) {
            line_of_part_ = line_of_part;
            const std::uint32_t line = part_.line_of(line_of_part);
            counts_ = line >= part_.first_counted;
            over_ = part_.end_counted != 0 && line >= part_.end_counted;
            operation_ = static_cast<std::size_t>(
                std::upper_bound(first_lines_.begin(), first_lines_.end(), line) -
                first_lines_.begin());
        }
        if (counts_ && !over_) {
            ++ticks_[operation_];
        }
    }

    // All counted lines have been executed.
    bool over() const { return over_; }
    const Ticks& ticks() const { return ticks_; }

private:
    const ProgramPart& part_;
    const std::vector<std::uint32_t>& first_lines_;
    Ticks ticks_;
    std::uint32_t line_of_part_{0};
    std::size_t operation_{0};
    bool counts_{part_.head_lines == 0};  // the first part from its start on
    bool over_{false};
};

// Shares of several parts, added up.
class SumOfShares {
public:
    SumOfShares(std::size_t parts, const std::function<void(double)>& progress)
        : progress_{progress}, shares_(parts, 0)
    {
    }

    void set(std::size_t part, double share)
    {
        const std::lock_guard lock{mutex_};
        sum_ += share - shares_[part];
        shares_[part] = share;
        if (progress_) {
            progress_(std::clamp(sum_, 0.0, 1.0));
        }
    }

private:
    const std::function<void(double)>& progress_;
    std::mutex mutex_;
    std::vector<double> shares_;
    double sum_{0};
};

// Runs a part. No value where the controller refuses it.
//
// done  receives the machine's time so far, s
std::optional<Ticks> ticks_of(const std::string& program,
                              const ProgramPart& part,
                              const std::vector<std::uint32_t>& first_lines,
                              const machine::Settings& settings,
                              const std::function<void(double)>& done)
{
    constexpr std::uint64_t kBetween = 1 << 16;  // ticks
    PartTicks counted{part, first_lines};
    RunOptions options = options_for_times(settings);
    options.set_point = [&counted](const program_run::SetPoint& point) {
        counted.add(point.line);
    };
    LineSource source = part_source("the program", program, part);
    ProgramRun run{source, options};
    for (std::uint64_t tick = 1; run.advance(); ++tick) {
        if (counted.over()) {
            return counted.ticks();
        }
        if (tick % kBetween == 0) {
            done(static_cast<double>(tick) / kServoTicksPerSecond);
        }
    }
    if (!run.result().good()) {
        return std::nullopt;
    }
    return counted.ticks();
}

}  // namespace

std::optional<std::vector<double>> simulated_times(const std::string& program,
                                                   const std::vector<std::size_t>& begins,
                                                   const std::function<void(double)>& progress,
                                                   double part,
                                                   const machine::Settings& settings)
{
    std::vector<std::uint32_t> first_lines;  // of all operations but the first
    for (std::size_t k = 1; k < begins.size(); ++k) {
        const auto from = program.begin() + static_cast<std::ptrdiff_t>(begins[k]);
        first_lines.push_back(
            static_cast<std::uint32_t>(1 + std::count(program.begin(), from, '\n')));
    }
    const std::vector<ProgramPart> parts = program_parts(program, part);
    double estimate = 1e-3;  // s; not 0 in a program without moves
    for (const ProgramPart& each : parts) {
        estimate += each.seconds;
    }
    std::vector<std::optional<Ticks>> ticks(parts.size());
    SumOfShares shares{parts.size(), progress};
    parallel::for_each(parts.size(), [&](std::size_t k) {
        const auto done = [&](double seconds) {
            shares.set(k, std::min(seconds, parts[k].seconds) / estimate);
        };
        ticks[k] = ticks_of(program, parts[k], first_lines, settings, done);
        done(parts[k].seconds);
    });
    std::vector<double> seconds(begins.size(), 0);
    for (const std::optional<Ticks>& counts : ticks) {
        if (!counts) {
            return std::nullopt;
        }
        for (std::size_t k = 0; k < begins.size(); ++k) {
            seconds[k] += static_cast<double>((*counts)[k]) / kServoTicksPerSecond;
        }
    }
    return seconds;
}

}  // namespace cusp::simulate
