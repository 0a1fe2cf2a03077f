// The one host program: `cusp COMMAND ...`.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/version_text.hpp"

#include "CLI/CLI.hpp"

namespace {

using namespace cusp::cli;

constexpr const char* kDescription =
    "Plan tool paths on parts and drawings, verify the cut, run programs through the controller's\n"
    "own motion core, and send them to a machine.\n"
    "\n"
    "  cusp demo                             do all of this with a pocket that comes with cusp\n"
    "  cusp info part.step                   describe a part: size, loops, the largest ball\n"
    "  cusp plan part.step --tool flat:8 ball:6 --scallop 0.02 -o part.ngc\n"
    "                                        tool paths for it, without a job file\n"
    "  cusp plan JOB.toml -o part.ngc        plan the operations of a job\n"
    "  cusp verify JOB.toml part.ngc         simulate the cut: gouge, scallop, remaining stock\n"
    "  cusp sim part.ngc --stats run.json    run it: time, limits, pulses\n"
    "  cusp view part.ngc -o run.html        see it: path, speeds, limits, in any browser\n"
    "  cusp studio                           all of this in a browser: part, operations, check, "
    "mill\n"
    "  cusp fit part.ngc -o arcs.ngc --tolerance 0.01\n"
    "                                        short lines to arcs and lines\n"
    "  cusp stream /dev/ttyUSB0 part.ngc     send it to a controller\n";

constexpr const char* kFooter =
    "'cusp COMMAND --help' explains a command.\n"
    "Exit status: 0 done; 1 the result is bad (a limit exceeded, an alarm, a gouge);\n"
    "2 the input or the command line is invalid.";

// In the order of --help.
const std::vector<AddCommand>& commands()
{
    static const std::vector<AddCommand> all{
        add_demo_command,   add_info_command,     add_plan_command,   add_verify_command,
        add_sim_command,    add_view_command,     add_studio_command, add_fit_command,
        add_stream_command, add_settings_command,
    };
    return all;
}

int run(int argc, char** argv)
{
    CLI::App app{kDescription, "cusp"};
    app.footer(kFooter);
    app.set_version_flag("--version", version_text);
    app.require_subcommand(1);
    Work work;
    for (const AddCommand add : commands()) {
        add(app, work);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
            std::fprintf(stderr, "cusp: no command \"%s\"; see cusp --help\n", argv[1]);
            return kCannotUse;
        }
        return app.exit(error) == 0 ? kDone : kCannotUse;
    }
    return work();
}

}  // namespace

int main(int argc, char** argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        // One line, even if a file name contains control characters.
        std::string text = error.what();
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        std::fprintf(stderr, "cusp: %s\n", text.c_str());
        return kCannotUse;
    }
}
