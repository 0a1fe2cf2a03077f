// `cusp sim`: runs a program through the firmware's core, or serves a virtual controller.
#include <fmt/format.h>
#include <memory>
#include <string>
#include <unistd.h>

#include "firmware/base/machine_limits.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/run_program.hpp"
#include "host_tools/controller/program_run/motion_profile.hpp"
#include "host_tools/controller/simulate/fault_command.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/controller/simulate/virtual_controller.hpp"
#include "host_tools/judge/report/motion_picture.hpp"

namespace cusp::cli {

using files::write_text;
using program_run::MotionProfile;
using program_run::ProgramMoveCounts;
using program_run::SetPoint;
using program_run::ToolTime;
using report::motion_picture;
using simulate::input_named;
using simulate::parse_line_faults;
using simulate::read_script;
using simulate::read_settings_file;
using simulate::ServeOptions;
using simulate::SimulationOptions;
using simulate::SimulationProgress;
using simulate::SimulationResult;

namespace {

struct SimArguments {
    std::string program;
    std::string settings_file;
    std::string vcd_file;
    std::string samples_file;
    std::string script_file;
    std::string stats_file;
    std::string picture_file;
    std::optional<double> probe_z;
    std::uint32_t bits_per_second{0};
    std::string dialect{"cusp"};
    bool serve{false};
    std::string pty_link;
    std::string tcp;
    std::string control;
    std::string line_faults;
    std::uint32_t seed{1};
    std::optional<std::uint64_t> cut_power_after;
    std::vector<std::string> stuck_high;
    std::vector<std::string> stuck_low;
};

void show_progress(const SimulationProgress& progress)
{
    constexpr int kCells = 30;
    const int filled = static_cast<int>(progress.fraction * kCells);
    fmt::print(stderr, "\r\x1b[K[{}{}] {:5.1f} %  line {}  {:.1f} s simulated",
               std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kCells - filled), '.'),
               100.0 * progress.fraction, progress.line, progress.simulated_s);
    std::fflush(stderr);
}

// Prints the greatest values of a derivative of the set points with the limits of the settings. Set
// points are whole nanometres; `rounding`, nm a tick to the power of the order, bounds the effect.
void print_limited(const char* name, int order, double rounding, Vec3d value, Vec3f limit)
{
    double added = rounding / kNanometresPerMillimetre;
    for (int k = 0; k < order; ++k) {
        added *= kServoTicksPerSecond;
    }
    fmt::print("{:<10} X {:.3f}  Y {:.3f}  Z {:.3f} mm/s{} at most", name, value.x, value.y,
               value.z, order == 1 ? "" : fmt::format("^{}", order));
    fmt::print(" (limits {:g}, {:g}, {:g}; up to {:g} is rounding to nanometres)\n", limit.x,
               limit.y, limit.z, added);
}

void print_result(const SimulationResult& result, const MachineLimits& limits)
{
    const ProgramMoveCounts& moves = result.moves;
    const Vec3d end = to_millimetres(result.end);
    fmt::print("{} lines, {} rapids, {} lines, {} arcs, {} NURBS\n", result.lines, moves.rapid,
               moves.line, moves.arc, moves.nurbs);
    fmt::print("time       {:.3f} s in motion, {:.1f} mm, simulated in {:.3f} s\n",
               result.duration_s, result.length_mm, result.wall_s);
    fmt::print("end        X {:.3f}  Y {:.3f}  Z {:.3f} mm\n", end.x, end.y, end.z);
    print_limited("speed", 1, 1, result.max_velocity, limits.velocity);
    print_limited("accel", 2, 2, result.max_acceleration, limits.acceleration);
    print_limited("jerk", 3, 4, result.max_jerk, limits.jerk);
    fmt::print("deviation  {:.6f} mm at most, in line {}\n", result.max_deviation_mm,
               result.max_deviation_line);
    if (result.starved_ticks > 0) {
        fmt::print("starved    {} ms without a line to run\n", result.starved_ticks);
    }
    if (result.tool_changes > 0) {
        fmt::print("tools     ");
        for (const ToolTime& tool : result.tools) {
            fmt::print(" T{} {:.1f} s{}", tool.number, tool.seconds(),
                       &tool == &result.tools.back() ? "" : ",");
        }
        fmt::print("; {} change{} of tool\n", result.tool_changes,
                   result.tool_changes == 1 ? "" : "s");
    }
    if (result.rotary_line > 0) {
        fmt::print("ignored    A, B and C words, from line {} on: they turn nothing\n",
                   result.rotary_line);
    }
    for (const std::uint64_t line : result.pause_lines) {
        fmt::print("pause      line {}: resumed at once\n", line);
    }
}

int run_once(const SimArguments& arguments)
{
    SimulationOptions options;
    if (!arguments.settings_file.empty()) {
        options.settings = read_settings_file(arguments.settings_file);
    }
    options.vcd_file = arguments.vcd_file;
    options.samples_file = arguments.samples_file;
    if (!arguments.script_file.empty()) {
        options.script = read_script(arguments.script_file);
    }
    options.probe_z = arguments.probe_z;
    options.bits_per_second = arguments.bits_per_second;
    options.stock_grbl = arguments.dialect == "grbl";
    options.sums_edges = !arguments.stats_file.empty();  // no other output has the sum
    const bool on_terminal = ::isatty(STDERR_FILENO) != 0;
    if (on_terminal) {
        options.progress = show_progress;
    }
    MotionProfile profile;
    if (!arguments.picture_file.empty()) {
        options.set_point = [&profile](const SetPoint& point) {
            profile.add(point.at, point.line);
        };
    }
    const SimulationResult result = run_program(arguments.program, options, arguments.stats_file);
    if (!arguments.picture_file.empty()) {
        write_text(arguments.picture_file, motion_picture(profile, options.settings.limits()));
    }
    if (on_terminal) {
        fmt::print(stderr, "\r\x1b[K");
    }
    print_result(result, options.settings.limits());
    std::fflush(stdout);
    print_faults(arguments.program, result);
    return result.good() ? kDone : kFoundWrong;
}

hal::TcpAddress address_of(const std::string& text, const char* option)
{
    const auto address = hal::parse_tcp_address(text);
    if (!address) {
        throw InputError{fmt::format("{} {}: is not HOST:PORT", option, text)};
    }
    return *address;
}

std::uint16_t inputs_of(const std::vector<std::string>& names, const char* option)
{
    unsigned bits = 0;
    for (const std::string& name : names) {
        const std::uint16_t bit = input_named(name);
        if (bit == 0) {
            throw InputError{
                fmt::format("{} {}: is none of x, y, z, probe, door, hold, start, reset, at-speed",
                            option, name)};
        }
        bits |= bit;
    }
    return static_cast<std::uint16_t>(bits);
}

int run_server(const SimArguments& arguments)
{
    ServeOptions options;
    options.pty_link = arguments.pty_link;
    if (!arguments.tcp.empty()) {
        options.tcp = address_of(arguments.tcp, "--tcp");
    }
    if (!arguments.control.empty()) {
        options.control = address_of(arguments.control, "--control");
    }
    const auto faults = parse_line_faults(arguments.line_faults);
    if (!faults) {
        throw InputError{fmt::format(
            "--line-faults {}: is no list of noise=, loss=, doubling=, delay= with 0 to 1",
            arguments.line_faults)};
    }
    options.settings_file = arguments.settings_file;
    options.faults = *faults;
    options.seed = arguments.seed;
    options.probe_z = arguments.probe_z;
    options.cut_power_after = arguments.cut_power_after;
    options.stuck_high = inputs_of(arguments.stuck_high, "--stuck-high");
    options.stuck_low = inputs_of(arguments.stuck_low, "--stuck-low");
    options.vcd_file = arguments.vcd_file;
    options.notice = [](const std::string& text) {
        fmt::print("{}\n", text);
        std::fflush(stdout);
    };
    serve(options, count_interruptions());
    return kDone;
}

int run_sim(const SimArguments& arguments)
{
    if (arguments.serve) {
        if (arguments.pty_link.empty() == arguments.tcp.empty()) {
            throw InputError{"cusp sim --serve needs one of --pty LINK and --tcp HOST:PORT"};
        }
        if (!arguments.program.empty()) {
            throw InputError{"cusp sim --serve takes no program: a sender sends it"};
        }
        if (arguments.dialect != "cusp") {
            throw InputError{"cusp sim --serve --dialect: only a program's lines are judged by it"};
        }
        return run_server(arguments);
    }
    if (arguments.program.empty()) {
        throw InputError{"cusp sim needs a program, or --serve"};
    }
    return run_once(arguments);
}

void add_serve_options(CLI::App& command, SimArguments& arguments)
{
    const char* group = "Virtual controller";
    command
        .add_flag("--serve", arguments.serve,
                  "Run as a controller in real time for any Grbl sender")
        ->group(group);
    command.add_option("--pty", arguments.pty_link, "Link to make to a new pseudo-terminal")
        ->group(group);
    command.add_option("--tcp", arguments.tcp, "HOST:PORT to listen on")->group(group);
    command
        .add_option("--control", arguments.control,
                    "HOST:PORT for commands: unplug, plug, power off|on, cut WORDS,\n"
                    "high|low|free INPUT, plate Z, line noise=P loss=P doubling=P delay=P,\n"
                    "lose-frame, overrun, where")
        ->group(group);
    command
        .add_option("--line-faults", arguments.line_faults,
                    "Probabilities a byte: noise=P,loss=P,doubling=P,delay=P")
        ->group(group);
    command.add_option("--seed", arguments.seed, "Seed of the line's random faults")->group(group);
    command
        .add_option("--cut-power-after", arguments.cut_power_after,
                    "Words written to the settings store before the power fails")
        ->group(group);
    command
        .add_option("--stuck-high", arguments.stuck_high,
                    "Input that always reads high: x, y, z, probe, door, hold, start, reset")
        ->group(group);
    command.add_option("--stuck-low", arguments.stuck_low, "Input that always reads low")
        ->group(group);
}

}  // namespace

void add_sim_command(CLI::App& app, Work& work)
{
    CLI::App* command = app.add_subcommand(
        "sim", "run a program through the controller's core, faster than real time");
    const auto arguments = std::make_shared<SimArguments>();
    command->add_option("program", arguments->program, "G-code to run from machine position 0,0,0");
    command->add_option("--settings", arguments->settings_file,
                        "Grbl settings, one $N=v a line; `cusp settings` prints the defaults");
    command->add_option("--vcd", arguments->vcd_file, "Write every step and direction edge");
    command->add_option("--samples", arguments->samples_file,
                        "Write the set point and the line of every ms");
    command->add_option(
        "--script", arguments->script_file,
        "Lines 'tick byte': realtime bytes and the servo ticks (ms) of their arrival");
    command->add_option("--stats", arguments->stats_file, "Write the figures as JSON");
    command->add_option("--picture", arguments->picture_file,
                        "Plot speed over time, and v, a, j of each axis with its limits (SVG)");
    command->add_option("--probe-z", arguments->probe_z,
                        "Height of a probe plate, mm from the start position");
    command->add_option("--baud", arguments->bits_per_second,
                        "Send the lines at this rate (default: without delay)");
    command
        ->add_option("--dialect", arguments->dialect,
                     "grbl refuses what stock Grbl 1.1 refuses, with its error numbers")
        ->check(CLI::IsMember({"cusp", "grbl"}))
        ->capture_default_str();
    add_serve_options(*command, *arguments);
    command->footer(
        "The first error or alarm ends the run: files are written up to there, exit status 1.\n"
        "M0, M1 and tool changes are resumed at once and listed; G4 takes its time.\n"
        "With --serve the settings file is read and kept up to date.");
    run_when_called(*command, work, arguments, run_sim);
}

}  // namespace cusp::cli
