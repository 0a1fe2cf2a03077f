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
// The simulation is the sender too: a line goes out as soon as the one before is answered, in no
// time. The first error or alarm ends the run.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/settings.hpp"
#include "host_tools/simulate/motion_statistics.hpp"
#include "host_tools/simulate/program_shadow.hpp"
#include "host_tools/simulate/tool_times.hpp"

namespace cusp::simulate {

// How far a run is; called some ten times a second.
struct SimulationProgress {
    double fraction;     // of the program's bytes
    std::uint64_t line;  // sent last
    double simulated_s;
};

// A realtime byte that the firmware reads before the servo tick of this number, counted from 0.
struct ScriptedByte {
    std::uint64_t tick;
    std::uint8_t byte;
};

// Reads lines `tick byte`, both decimal, ticks not falling. Throws InputError.
std::vector<ScriptedByte> read_script(const std::string& file);

struct SimulationOptions {
    machine::Settings settings;
    // While it has bytes left a hold lasts until the script's cycle start; without, it is over at
    // once.
    std::vector<ScriptedByte> script;
    // Files to write; empty: none.
    std::string vcd_file;
    std::string samples_file;
    // Height of the probe plate over the start, mm.
    std::optional<double> probe_z;
    // Bits per second of the serial line; 0: lines take no time.
    std::uint32_t bits_per_second{0};
    std::function<void(const SimulationProgress&)> progress;
    // Called when the first set point of a line has been reached; for tables of times.
    std::function<void(std::uint32_t line, double seconds)> line_started;
    // Ends the run where it returns true; asked some ten times a second.
    std::function<bool()> stop;
};

// An answer that ended the run, or a line that the sender could not send.
struct SimulationError {
    std::uint64_t line;  // of the program
    int code;            // Grbl's; 0 where the fault is not the firmware's
    std::string text;
    std::string block;  // the line as the program has it; empty where the fault is not a line's
    std::string word;   // of the block, the one that is refused; empty where no single word is
};

struct SimulationResult {
    double duration_s{0};  // from the first to the last moving tick
    double total_s{0};     // dwells at both ends too
    double wall_s{0};
    std::uint64_t lines{0};
    ProgramMoveCounts moves;
    PerAxis<std::uint64_t> steps{};  // pulses, both ways
    Position end;                    // machine coordinates
    double length_mm{0};
    Vec3d max_velocity;
    Vec3d max_acceleration;
    Vec3d max_jerk;
    double max_deviation_mm{0};
    std::uint64_t max_deviation_line{0};
    std::uint64_t starved_ticks{0};
    int alarm{0};  // Grbl's code; 0: none
    std::vector<SimulationError> errors;
    // M0, M1 and tool changes, which went on at once.
    std::vector<std::uint64_t> pause_lines;
    std::uint64_t pauses{0};
    std::vector<ToolTime> tools;  // in the order of their first use
    std::uint64_t tool_changes{0};
    bool stopped{false};

    bool good() const { return errors.empty() && alarm == 0 && !stopped; }
};

// Throws InputError where a file can't be read or written.
SimulationResult simulate(const std::string& program_file, const SimulationOptions& options);

// The result as JSON, one key a figure.
std::string statistics_json(const SimulationResult& result);

}  // namespace cusp::simulate
