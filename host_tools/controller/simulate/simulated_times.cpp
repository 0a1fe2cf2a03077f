// Counts the servo ticks of each operation by the line that the machine executes.
#include "host_tools/controller/simulate/simulated_times.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <mutex>
#include <string_view>

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
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        constexpr float kFewSteps = 1;  // a millimetre
        options.settings.put(100 + axis, kFewSteps);
    }
    return options;
}

// Servo ticks of an operation.
struct OperationTicks {
    std::uint64_t all{0};
    std::uint64_t rapid{0};
};
using Ticks = std::vector<OperationTicks>;

// The motion of the last G word of a line, such as 0 or 83; none where it has none.
std::optional<int> motion_of(std::string_view line)
{
    constexpr int kCurves = 6;   // G5 and G6 and their likes
    constexpr int kCycles = 73;  // and more: of drills
    std::optional<int> motion;
    for (std::size_t at = 0; at < line.size() && line[at] != '(' && line[at] != ';'; ++at) {
        if (line[at] != 'G' && line[at] != 'g') {
            continue;
        }
        int code = -1;
        std::from_chars(line.data() + at + 1, line.data() + line.size(), code);
        const bool is_motion =
            (code >= 0 && code <= kCurves && code != 4) || (code >= kCycles && code < 90);
        motion = is_motion ? std::optional{code} : motion;
    }
    return motion;
}

// True for each line, from 1, that moves at the rapid rate.
std::vector<bool> rapid_lines(std::string_view program)
{
    std::vector<bool> rapid{false};
    bool is_rapid = false;
    while (!program.empty()) {
        const std::size_t end = std::min(program.find('\n'), program.size());
        if (const auto motion = motion_of(program.substr(0, end))) {
            is_rapid = *motion == 0;
        }
        rapid.push_back(is_rapid);
        program.remove_prefix(std::min(end + 1, program.size()));
    }
    return rapid;
}

// The kinds of lines that times are counted by.
struct LineKinds {
    std::vector<std::uint32_t> first_lines;  // of all operations but the first
    std::vector<bool> rapid;
};

// The ticks on the counted lines of one part.
class PartTicks {
public:
    PartTicks(const ProgramPart& part, const LineKinds& lines)
        : part_{part}, lines_{lines}, ticks_(lines.first_lines.size() + 1)
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
            const auto& first_lines = lines_.first_lines;
            operation_ = static_cast<std::size_t>(
                std::upper_bound(first_lines.begin(), first_lines.end(), line) -
                first_lines.begin());
            is_rapid_ = line < lines_.rapid.size() && lines_.rapid[line];
        }
        if (counts_ && !over_) {
            ++ticks_[operation_].all;
            ticks_[operation_].rapid += is_rapid_ ? 1 : 0;
        }
    }

    // All counted lines have been executed.
    bool over() const { return over_; }
    const Ticks& ticks() const { return ticks_; }

private:
    const ProgramPart& part_;
    const LineKinds& lines_;
    Ticks ticks_;
    std::uint32_t line_of_part_{0};
    std::size_t operation_{0};
    bool is_rapid_{false};
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
                              const LineKinds& lines,
                              const machine::Settings& settings,
                              const std::function<void(double)>& done)
{
    constexpr std::uint64_t kBetween = 1 << 16;  // ticks
    PartTicks counted{part, lines};
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

std::optional<std::vector<OperationTime>> simulated_times(
    const std::string& program,
    const std::vector<std::size_t>& begins,
    const std::function<void(double)>& progress,
    double part,
    const machine::Settings& settings)
{
    LineKinds lines{{}, rapid_lines(program)};
    for (std::size_t k = 1; k < begins.size(); ++k) {
        const auto from = program.begin() + static_cast<std::ptrdiff_t>(begins[k]);
        lines.first_lines.push_back(
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
        ticks[k] = ticks_of(program, parts[k], lines, settings, done);
        done(parts[k].seconds);
    });
    std::vector<OperationTime> times(begins.size());
    for (const std::optional<Ticks>& counts : ticks) {
        if (!counts) {
            return std::nullopt;
        }
        for (std::size_t k = 0; k < begins.size(); ++k) {
            times[k].seconds += static_cast<double>((*counts)[k].all) / kServoTicksPerSecond;
            times[k].rapid_s += static_cast<double>((*counts)[k].rapid) / kServoTicksPerSecond;
        }
    }
    return times;
}

}  // namespace cusp::simulate
