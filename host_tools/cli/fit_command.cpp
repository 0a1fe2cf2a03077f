// cusp fit: replaces short lines by arcs and lines, checks the result, writes statistics.
#include <chrono>
#include <memory>
#include <string>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/controller/program_fit/program_fit.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

namespace {

struct FitOptions {
    std::string program;
    std::string output;
    std::string stats;
    double tolerance{};
};

int run_fit(const FitOptions& options)
{
    const auto begin = std::chrono::steady_clock::now();
    const std::string program = files::text_of_file(options.program);
    const program_fit::FittedProgram fitted = program_fit::fit_program(
        program, options.program, options.tolerance, ShareProgress{"fitting"});
    files::write_text(options.output, fitted.text);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const program_fit::FitReport& report = fitted.report;
    write_wanted(options.stats,
                 [&] { return program_fit::statistics_json(report, options.tolerance, seconds); });
    fmt::print(
        "{} feed moves became {}: {} lines, {} arcs; off by at most {:.4f} mm at a vertex, "
        "{:.4f} mm between\n",
        report.moves_in, report.moves_out, report.lines, report.arcs,
        report.max_vertex_deviation_mm, report.max_deviation_mm);
    fmt::print("wrote {} ({:.0f} lines/s)\n", options.output,
               static_cast<double>(report.lines_read) / seconds);
    return kDone;
}

}  // namespace

void add_fit_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand("fit", "replace runs of short lines by arcs and lines");
    command->footer(
        "Vertices are within the tolerance, midpoints of lines within 1.1 times of it. The result\n"
        "is read again and measured before it is written. Other lines stay as they are.\n"
        "Statistics are in mm and s, whatever the program's units; moves are feed moves.");
    auto options = std::make_shared<FitOptions>();
    command->add_option("IN", options->program, "G-code to read")->required();
    command->add_option("-o,--output", options->output, "G-code to write")->required();
    command->add_option("--tolerance", options->tolerance, "of the path, mm")
        ->required()
        ->check(CLI::Range(0.0001, 10.0));
    command->add_option("--stats", options->stats, "statistics to write (JSON)");
    run_when_called(*command, work, options, run_fit);
}

}  // namespace cusp::cli
