// `cusp sim`: runs a program through the firmware's core, or serves a virtual controller.
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/controller/program_run/motion_profile.hpp"
#include "host_tools/controller/simulate/fault_command.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/controller/simulate/virtual_controller.hpp"
#include "host_tools/judge/report/motion_picture.hpp"

namespace cusp::cli {

using simulate::ServeOptions;

namespace {

constexpr const char* kServing = "Virtual controller";

struct SimArguments {
    std::string program;
    std::string settings_file;
    std::string script_file;
    std::string stats_file;
    std::string picture_file;
    std::string dialect{"cusp"};
    simulate::SimulationOptions run;
    bool serves{false};
    ServeOptions serve;  // the VCD file and the probe's height are those of `run`
};

int run_once(const SimArguments& arguments)
{
    simulate::SimulationOptions options = arguments.run;
    if (!arguments.settings_file.empty()) {
        options.settings = simulate::read_settings_file(arguments.settings_file);
    }
    if (!arguments.script_file.empty()) {
        options.script = simulate::read_script(arguments.script_file);
    }
    options.stock_grbl = arguments.dialect == "grbl";
    options.sums_edges = !arguments.stats_file.empty();  // no other output has the sum
    options.stop = was_interrupted();
    constexpr double kQuiet = 2.0;  // s
    ShareProgress bar{"running", kQuiet};
    options.progress = [&bar](const simulate::SimulationProgress& progress) {
        bar(progress.fraction);
    };
    program_run::MotionProfile profile;
    if (!arguments.picture_file.empty()) {
        options.set_point = [&profile](const program_run::SetPoint& point) {
            profile.add(point.at, point.line);
        };
    }
    const simulate::SimulationResult result = simulate::simulate(arguments.program, options);
    write_wanted(arguments.stats_file, [&] { return statistics_json(result); });
    write_wanted(arguments.picture_file,
                 [&] { return report::motion_picture(profile, options.settings.limits()); });
    fmt::print("{}", summary_text(result, options.settings.limits()));
    std::fflush(stdout);
    fmt::print(stderr, "{}", faults_text(arguments.program, result));
    return result.good() ? kDone : kFoundWrong;
}

// The value that was parsed from the text of an option. Errors: InputError where there is none.
template <class Value>
Value value_of(const std::optional<Value>& parsed, const std::string& option, const char* fault)
{
    if (!parsed) {
        throw InputError{fmt::format("{}: {}", option, fault)};
    }
    return *parsed;
}

hal::LineFaults faults_of(const std::string& text)
{
    return value_of(simulate::parse_line_faults(text), "--line-faults " + text,
                    "is no list of noise=, loss=, doubling=, delay= with 0 to 1");
}

int run_server(const SimArguments& arguments)
{
    ServeOptions options = arguments.serve;
    options.settings_file = arguments.settings_file;
    options.probe_z = arguments.run.probe_z;
    options.vcd_file = arguments.run.vcd_file;
    options.notice = [](const std::string& text) {
        fmt::print("{}\n", text);
        std::fflush(stdout);
    };
    serve(options, count_interruptions());
    return kDone;
}

int run_sim(const SimArguments& arguments)
{
    if (arguments.serves) {
        if (arguments.serve.pty_link.empty() == !arguments.serve.tcp) {
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
    ServeOptions& serve = arguments.serve;
    const auto add = [&](const char* name, auto& value, const char* text) {
        command.add_option(name, value, text)->group(kServing);
    };
    const auto add_read = [&](const char* name, auto& value, auto read, const char* text) {
        command
            .add_option_function<std::string>(
                name, [&value, read](const std::string& given) { value = read(given); }, text)
            ->group(kServing);
    };
    const auto add_inputs = [&](const char* name, std::uint16_t& value, const char* text) {
        command
            .add_option_function<std::vector<std::string>>(
                name,
                [&value, name](const std::vector<std::string>& given) {
                    value = simulate::inputs_named(given, name);
                },
                text)
            ->group(kServing);
    };
    const auto address = [](const char* option) {
        return [option](const std::string& text) {
            return value_of(hal::parse_tcp_address(text), fmt::format("{} {}", option, text),
                            "is not HOST:PORT");
        };
    };
    command
        .add_flag("--serve", arguments.serves,
                  "Run as a controller in real time for any Grbl sender")
        ->group(kServing);
    add("--pty", serve.pty_link, "Link to make to a new pseudo-terminal");
    add_read("--tcp", serve.tcp, address("--tcp"), "HOST:PORT to listen on");
    add_read("--control", serve.control, address("--control"),
             "HOST:PORT for commands: unplug, plug, power off|on, cut WORDS,\n"
             "high|low|free INPUT, plate Z, line noise=P loss=P doubling=P delay=P,\n"
             "lose-frame, overrun, where");
    add_read("--line-faults", serve.faults, faults_of,
             "Probabilities a byte: noise=P,loss=P,doubling=P,delay=P");
    add("--seed", serve.seed, "Seed of the line's random faults");
    add("--cut-power-after", serve.cut_power_after,
        "Words written to the settings store before the power fails");
    add_inputs("--stuck-high", serve.stuck_high,
               "Input that always reads high: x, y, z, probe, door, hold, start, reset");
    add_inputs("--stuck-low", serve.stuck_low, "Input that always reads low");
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
    command->add_option("--vcd", arguments->run.vcd_file, "Write every step and direction edge");
    command->add_option("--samples", arguments->run.samples_file,
                        "Write the set point and the line of every ms");
    command->add_option(
        "--script", arguments->script_file,
        "Lines 'tick byte': realtime bytes and the servo ticks (ms) of their arrival");
    command->add_option("--stats", arguments->stats_file, "Write the figures as JSON");
    command->add_option("--picture", arguments->picture_file,
                        "Plot speed over time, and v, a, j of each axis with its limits (SVG)");
    command->add_option("--probe-z", arguments->run.probe_z,
                        "Height of a probe plate, mm from the start position");
    command->add_option("--baud", arguments->run.bits_per_second,
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
