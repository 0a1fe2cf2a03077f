// Collects the measures of a run.
#include "host_tools/controller/program_run/instruments.hpp"

namespace cusp::program_run {
namespace {

constexpr double kSecondsPerTick = 1.0 / kServoTicksPerSecond;

}  // namespace

Instruments::Instruments(board_sim::SimulatedController& controller, const RunOptions& options)
    : controller_{controller},
      motion_{controller.machine().motion()},
      player_{controller.board().pulse_player},
      options_{options},
      start_steps_{controller.board().mill.steps_taken()},
      start_tick_{player_.next_frame_start()},
      statistics_{motion_.position()},
      shadow_{motion_.position(), path_listener(), controller.machine().settings().axes()},
      checksum_{start_tick_, player_.levels(), controller.machine().settings().axes()},
      delay_us_{controller.machine().settings().steps().direction_setup_us}
{
    if (options_.sums_edges) {
        player_.add_listener(checksum_);
    }
    if (options_.started) {
        options_.started(controller_.board());
    }
    if (options_.set_point) {
        options_.set_point(
            {time_of_set_point() - kPulseTicksPerFrame, motion_.position(), 0, 0.0, false, 0});
    }
}

void Instruments::tick()
{
    controller_.tick_firmware();
    const Position at = motion_.position();
    const std::uint32_t line = motion_.executing_line();
    if (options_.measures_motion) {
        statistics_.add(at);
    }
    tool_times_.add_tick(line);
    const bool on_path = !controller_.machine().changing_tool();
    const double deviation =
        on_path && options_.measures_deviation ? deviation_.add_set_point(at) : 0.0;
    if (options_.set_point) {
        options_.set_point(
            {time_of_set_point(), at, line, deviation, on_path, motion_.laser().duty()});
    }
    controller_.tick_world();
}

void Instruments::finish(RunResult& result)
{
    controller_.tick_world();
    controller_.tick_world();
    statistics_.finish();
    result.duration_s = static_cast<double>(statistics_.moving_ticks()) * kSecondsPerTick;
    result.total_s = static_cast<double>(statistics_.ticks()) * kSecondsPerTick;
    result.moves = shadow_.moves();
    result.end = statistics_.end();
    result.length_mm = statistics_.length();
    result.max_velocity = statistics_.max_velocity();
    result.max_acceleration = statistics_.max_acceleration();
    result.max_jerk = statistics_.max_jerk();
    result.max_deviation_mm = deviation_.greatest();
    result.max_deviation_line = deviation_.line();
    result.tools = tool_times_.times();
    result.tool_changes = tool_times_.changes();
    result.edges_crc32 = options_.sums_edges ? checksum_.value() : 0;
    result.axes = controller_.machine().settings().axes();
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        result.steps[axis] = controller_.board().mill.steps_taken()[axis] - start_steps_[axis];
    }
}

LineEffects Instruments::read(std::string_view line, std::uint64_t number)
{
    const LineEffects effects = shadow_.read(line, number);
    tool_times_.read_line(number, shadow_.tool());
    return effects;
}

PathListener Instruments::path_listener()
{
    if (!options_.measures_deviation) {
        return options_.path;
    }
    return [this](const path::Move* move) {
        if (move != nullptr) {
            deviation_.add_move(*move);
        } else {
            deviation_.restart();
        }
    };
}

double Instruments::seconds() const
{
    return static_cast<double>(statistics_.ticks()) * kSecondsPerTick;
}

// Time of the last set point on the clock of the trace: the end of the frame that was just handed over.
std::uint64_t Instruments::time_of_set_point() const
{
    return player_.next_frame_start() - start_tick_ + kPulseTicksPerFrame + delay_us_;
}

}  // namespace cusp::program_run
