// Instruments: everything that measures the controller while it runs a program.
#pragma once

#include <optional>
#include <string_view>

#include "boards/sim/simulated_controller.hpp"
#include "host_tools/controller/program_run/edge_checksum.hpp"
#include "host_tools/controller/program_run/motion_statistics.hpp"
#include "host_tools/controller/program_run/path_deviation.hpp"
#include "host_tools/controller/program_run/program_run.hpp"

namespace cusp::program_run {

class Instruments {
public:
    // Both arguments must outlive the instruments, and the instruments the last tick of the controller.
    Instruments(board_sim::SimulatedController& controller, const RunOptions& options);
    Instruments(const Instruments&) = delete;
    Instruments& operator=(const Instruments&) = delete;

    // One servo tick of all measures.
    void tick();

    // Plays the frames in flight and fills in the measures.
    void finish(RunResult& result);

    // The next line of the program, before it is sent.
    LineEffects read(std::string_view line, std::uint64_t number);

    ProgramShadow& shadow() { return shadow_; }
    double seconds() const;

private:
    std::uint64_t time_of_set_point() const;
    PathListener path_listener();

    board_sim::SimulatedController& controller_;
    const machine::Motion& motion_;
    hal::SimulatedPlayer& player_;
    const RunOptions& options_;
    PerAxis<std::uint64_t> start_steps_;
    std::uint64_t start_tick_;
    MotionStatistics statistics_;
    PathDeviation deviation_;
    ProgramShadow shadow_;
    ToolTimes tool_times_;
    EdgeChecksum checksum_;
    std::uint64_t delay_us_;
};

}  // namespace cusp::program_run
