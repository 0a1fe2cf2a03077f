// Runs a program through the whole firmware, faster than real time, and measures the motion. The
// front door of `simulate`; virtual_controller.hpp runs the firmware in real time for a sender.
//
//     SimulationOptions options;
//     options.settings = read_settings_file("mill.settings");
//     options.vcd_file = "part.vcd";  // every edge of the step and direction lines
//     const SimulationResult run = simulate("part.ngc", options);
//     if (run.good()) {
//         fmt::print("{:.1f} s, off the path by {} mm\n", run.duration_s, run.max_deviation_mm);
//     }
//
// The simulation also acts as the sender: a line is sent as soon as the one before is answered,
// without delay. The first error or alarm ends the run.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "firmware/base/machine_limits.hpp"
#include "host_tools/controller/program_run/program_run.hpp"

namespace cusp::simulate {

using SetPoint = program_run::SetPoint;

// Progress of a run; reported some ten times a second.
struct SimulationProgress {
    double fraction;     // of the program's bytes
    std::uint64_t line;  // sent last
    double simulated_s;
};

// Reads lines `tick byte`, both decimal, ticks not falling. Throws InputError.
std::vector<program_run::ScriptedByte> read_script(const std::string& file);

struct SimulationOptions : program_run::RunOptions {
    // Files to write; empty: none.
    std::string vcd_file;
    std::string samples_file;
    std::function<void(const SimulationProgress&)> progress;
    // Called when the first set point of a line has been reached; for tables of times.
    std::function<void(std::uint32_t line, double seconds)> line_started;
    // Ends the run if it returns true; polled some ten times a second.
    std::function<bool()> stop;
};

struct SimulationResult : program_run::RunResult {
    double wall_s{0};
};

// Errors: InputError if a file cannot be read or written.
SimulationResult simulate(const std::string& program_file, const SimulationOptions& options);
// A program from anywhere: dialect::LineSource::of_text("part.ngc", gcode).
SimulationResult simulate(dialect::LineSource& program, const SimulationOptions& options);

// The result as JSON, one key a figure.
std::string statistics_json(const SimulationResult& result);
// For people: times, end, and the greatest speeds beside their limits.
std::string summary_text(const SimulationResult& result, const MachineLimits& limits);
// Why the run ended early, a line each: "part.ngc:12: error 20: ..."; "": it did not.
std::string faults_text(const std::string& program_file, const SimulationResult& result);

}  // namespace cusp::simulate
