// ProgramRun: a program through the whole firmware in virtual time, and its measures. Neither files nor
// exceptions: host and browser run the same code.
//
//     auto source = dialect::LineSource::of_text("part.ngc", text);
//     ProgramRun run{source, {}};
//     while (run.advance()) {
//     }
//     const RunResult result = run.result();
//
// The run also acts as the sender: a line is sent as soon as the one before is answered, without
// delay. The first error or alarm ends the run.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/settings.hpp"
#include "firmware/path/move.hpp"
#include "hal/sim/simulated_board.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/program_run/program_shadow.hpp"
#include "host_tools/controller/program_run/tool_times.hpp"

namespace cusp::program_run {

// A realtime byte that the firmware reads before the servo tick of this number, counted from 0.
struct ScriptedByte {
    std::uint64_t tick;
    std::uint8_t byte;
};

// Position of the machine at the end of a servo tick.
struct SetPoint {
    std::uint64_t microseconds;  // on the clock of the pulse trace
    Position at;
    std::uint32_t line;      // of the program, that it executes; 0 before the first
    double deviation_mm;     // from the programmed path; 0 where it is not measured
    bool on_path;            // false: at the start, or away from the path to change a tool
    std::uint16_t power{0};  // of a laser in the tick that ends here, 0 to kFullDuty
};

// Receives the moves of the programmed path, each before the set points on it; null: the machine has
// moved by itself, and the path continues with the next move.
using PathListener = std::function<void(const path::Move*)>;

struct RunOptions {
    machine::Settings settings;
    // While bytes are left, a hold lasts until the script's cycle start; afterwards a hold ends at
    // once.
    std::vector<ScriptedByte> script;
    // Refuses what stock Grbl 1.1 refuses (stock_grbl.hpp).
    bool stock_grbl{false};
    // Height of the probe plate above the start, mm.
    std::optional<double> probe_z;
    // Bits per second of the serial line; 0: lines take no time.
    std::uint32_t bits_per_second{0};
    // True if set points are measured: for seconds() and the result's duration_s, total_s, end,
    // length_mm, max_velocity, max_acceleration and max_jerk.
    bool measures_motion{true};
    // True if the deviation from the programmed path is measured.
    bool measures_deviation{true};
    // Receives the path for a measurement elsewhere.
    PathListener path;
    // True if the edges of the pulses are summed.
    bool sums_edges{true};
    // Called once, when the machine has homed and is where the program starts.
    std::function<void(hal::SimulatedBoard&)> started;
    // Called for the start and for every servo tick.
    std::function<void(const SetPoint&)> set_point;
};

// An error answer or alarm that ended the run, or a line that could not be sent.
struct RunError {
    std::uint64_t line;  // of the program
    int code;            // Grbl's; 0 where the fault is not the firmware's
    std::string text;
    std::string block;  // the line as in the program; empty where the fault is not of a line
    std::string word;   // the refused word of the block; empty where no single word is wrong
};

struct RunResult {
    double duration_s{0};  // from the first to the last moving tick
    double total_s{0};     // dwells at both ends too
    std::uint64_t lines{0};
    ProgramMoveCounts moves;
    unsigned axes{kLinearAxes};      // of the machine, X first
    PerAxis<std::uint64_t> steps{};  // pulses, both ways
    Position end;                    // machine coordinates
    double length_mm{0};
    AxisVecd max_velocity;
    AxisVecd max_acceleration;
    AxisVecd max_jerk;
    double max_deviation_mm{0};
    std::uint64_t max_deviation_line{0};
    std::uint64_t starved_ticks{0};
    int alarm{0};  // Grbl's code; 0: none
    std::vector<RunError> errors;
    // M0, M1 and tool changes, which are resumed at once.
    std::vector<std::uint64_t> pause_lines;
    std::uint64_t pauses{0};
    std::vector<ToolTime> tools;  // in the order of their first use
    std::uint64_t tool_changes{0};
    std::uint64_t rotary_line{0};  // the first with A, B or C words, which are ignored; 0: none
    std::uint32_t edges_crc32{0};  // see EdgeChecksum; 0 where edges are not summed
    bool stopped{false};

    bool good() const { return errors.empty() && alarm == 0 && !stopped; }
};

// An error of a result as a line: "error:20: a G or M word is not supported".
std::string fault_text(const RunResult& result, const RunError& error);

class ProgramRun {
public:
    // Both arguments must outlive the run.
    ProgramRun(dialect::LineSource& source, const RunOptions& options);
    ~ProgramRun();
    ProgramRun(const ProgramRun&) = delete;
    ProgramRun& operator=(const ProgramRun&) = delete;

    // Advances at most one servo tick. Returns false at the end of the run.
    bool advance();

    // Stops sending; the run ends when the machine is at rest.
    void stop();

    // Fraction of the program's bytes that are sent, line sent last, and machine time so far.
    double fraction() const;
    std::uint64_t line() const;
    double seconds() const;

    // Precondition: advance() returned false.
    const RunResult& result() const;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace cusp::program_run
