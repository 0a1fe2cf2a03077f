// A run with its input and output files.
#include "host_tools/controller/simulate/simulate.hpp"

#include <chrono>
#include <memory>

#include "host_tools/controller/simulate/samples_writer.hpp"
#include "host_tools/controller/simulate/vcd_writer.hpp"

namespace cusp::simulate {

using program_run::ProgramRun;
using program_run::RunOptions;

namespace {

using WallClock = std::chrono::steady_clock;

// Passes the set points and edges of a run to its writers and callbacks.
class Recorder {
public:
    explicit Recorder(const SimulationOptions& options) : options_{options}
    {
        if (!options.samples_file.empty()) {
            samples_ = std::make_unique<SamplesWriter>(
                options.samples_file, options.settings.on(machine::Setting::kLaserMode),
                options.settings.axes());
        }
    }

    // Options of the run itself. The recorder must outlive it.
    RunOptions run_options()
    {
        RunOptions run = options_;
        if (!options_.vcd_file.empty()) {
            run.started = [this](hal::SimulatedBoard& board) {
                start_trace(board);
            };
        }
        if (samples_ || options_.line_started || options_.set_point) {
            run.set_point = [this](const SetPoint& set_point) {
                take(set_point);
            };
        }
        return run;
    }

    void close()
    {
        if (vcd_) {
            vcd_->close();
        }
        if (samples_) {
            samples_->close();
        }
    }

private:
    void start_trace(hal::SimulatedBoard& board)
    {
        vcd_ = std::make_unique<VcdWriter>(options_.vcd_file, board.mill,
                                           board.pulse_player.next_frame_start(),
                                           board.pulse_player.levels(), options_.settings.axes());
        board.pulse_player.add_listener(*vcd_);
        if (options_.started) {
            options_.started(board);
        }
    }

    void take(const SetPoint& set_point)
    {
        if (samples_) {
            samples_->write(set_point.microseconds, set_point.at, set_point.line, set_point.power);
        }
        if (options_.set_point) {
            options_.set_point(set_point);
        }
        if (options_.line_started && set_point.line != line_) {
            constexpr double kSecondsPerTick = 1.0 / kServoTicksPerSecond;
            options_.line_started(set_point.line, static_cast<double>(ticks_) * kSecondsPerTick);
        }
        line_ = set_point.line;
        ++ticks_;
    }

    const SimulationOptions& options_;
    std::unique_ptr<VcdWriter> vcd_;
    std::unique_ptr<SamplesWriter> samples_;
    std::uint64_t ticks_{0};  // the first set point is the start
    std::uint32_t line_{0};
};

// Reports progress and polls for a stop, some ten times a second.
class Reporter {
public:
    Reporter(ProgramRun& run, const SimulationOptions& options) : run_{run}, options_{options} {}

    void tick()
    {
        constexpr std::chrono::milliseconds kBetween{100};
        if (++ticks_ % 1024 != 0 || WallClock::now() - last_ < kBetween) {
            return;
        }
        last_ = WallClock::now();
        if (options_.progress) {
            options_.progress({run_.fraction(), run_.line(), run_.seconds()});
        }
        if (options_.stop && options_.stop()) {
            run_.stop();
        }
    }

private:
    ProgramRun& run_;
    const SimulationOptions& options_;
    std::uint64_t ticks_{0};
    WallClock::time_point last_{};
};

}  // namespace

SimulationResult simulate(const std::string& program_file, const SimulationOptions& options)
{
    dialect::LineSource source{program_file};
    return simulate(source, options);
}

SimulationResult simulate(dialect::LineSource& program, const SimulationOptions& options)
{
    const auto start = WallClock::now();
    Recorder recorder{options};
    const RunOptions run_options = recorder.run_options();
    ProgramRun run{program, run_options};
    Reporter reporter{run, options};
    while (run.advance()) {
        reporter.tick();
    }
    recorder.close();
    SimulationResult result{run.result(), 0};
    result.wall_s = std::chrono::duration<double>(WallClock::now() - start).count();
    return result;
}

}  // namespace cusp::simulate
