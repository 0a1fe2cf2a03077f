// cusp verify: cuts a program in memory and judges what stands.
#include <cmath>
#include <cstdio>
#include <memory>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/import/import.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/report/pictures.hpp"
#include "host_tools/simulate/text_file.hpp"
#include "host_tools/verify/verify.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::cli {

using import::read_job;
using job::Job;
using report::left_picture;
using report::path_picture;
using simulate::write_text;
using verify::Verification;
using verify::VerifyFigures;
using verify::VerifySettings;

namespace {

using Json = nlohmann::ordered_json;

struct VerifyOptions {
    std::string job;
    std::string program;
    std::string stats;
    std::string path_picture;
    std::string left_picture;
    double pitch{};
    double spacing{};
};

double rounded(double value)
{
    constexpr double kMicro = 1e6;
    return std::round(value * kMicro) / kMicro;
}

Json stats_of(const Verification& result)
{
    const VerifyFigures& f = result.figures;
    Json out{{"moves",
              {{"rapid", f.moves.rapids},
               {"line", f.moves.lines},
               {"arc", f.moves.arcs},
               {"nurbs", f.moves.nurbs}}},
             {"cut_length_mm", rounded(f.cut_length)},
             {"rapid_length_mm", rounded(f.rapid_length)},
             {"tool_positions", f.tool_positions},
             {"rapid_cut_max_mm", rounded(f.rapid_cut_max)},
             {"cut_depth_max_mm", rounded(f.cut_depth_max)},
             {"gouge_max_mm", rounded(f.gouge_max)}};
    const auto optional = [&](const char* name, std::optional<double> value) {
        if (value && std::isfinite(*value)) {
            out[name] = rounded(*value);
        }
    };
    optional("ball_gouge_max_mm", f.ball_gouge_max);
    optional("wall_gouge_max_mm", f.wall_gouge_max);
    optional("wall_left_max_mm", f.wall_left_max);
    out["cells"] = f.cells;
    out["unreachable_share"] = rounded(f.unreachable_share);
    out["uncut_share"] = rounded(f.uncut_share);
    out["scallop_max_mm"] = rounded(f.scallop_max);
    out["scallop_p99_mm"] = rounded(f.scallop_p99);
    out["scallop_mean_mm"] = rounded(f.scallop_mean);
    out["left_volume_mm3"] = rounded(f.left_volume);
    if (f.scallop_bound) {
        out["scallop_bound_mm"] = *f.scallop_bound;
        out["uncovered_share"] = rounded(f.uncovered_share);
        if (f.thickest_left) {
            const auto& [thickness, at] = *f.thickest_left;
            out["left_thickness_mm"] = rounded(thickness);
            out["left_thickness_at_mm"] = {rounded(at.x), rounded(at.y), rounded(at.z)};
        }
    }
    out["broken"] = result.broken;
    return out;
}

int run_verify(const VerifyOptions& options)
{
    const Job job = read_job(options.job);
    VerifySettings settings;
    if (options.pitch > 0) {
        settings.pitch = options.pitch;
    }
    if (options.spacing > 0) {
        settings.spacing = options.spacing;
    }
    const Verification result =
        verify::verify(job, options.program, settings, ShareProgress{"cutting"});
    const Json stats = stats_of(result);
    for (const auto& [name, value] : stats.items()) {
        if (name != "broken") {
            fmt::print("{}: {}\n", name, value.dump());
        }
    }
    if (!options.stats.empty()) {
        write_text(options.stats, stats.dump(1) + "\n");
    }
    if (!options.path_picture.empty()) {
        write_text(options.path_picture, path_picture(job, result.program));
    }
    if (!options.left_picture.empty()) {
        write_text(options.left_picture, left_picture(job, result));
    }
    for (const std::string& broken : result.broken) {
        fmt::print("broken: {}\n", broken);
    }
    if (result.broken.empty()) {
        fmt::print("all bounds hold\n");
    }
    return result.broken.empty() ? kDone : kFoundWrong;
}

}  // namespace

void add_verify_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand(
        "verify", "cut a program's stock in memory; report gouge, scallop and what is left");
    command->footer(
        "Gouge and scallop are measured square to the surface, in mm, whatever the job's units.\n"
        "Exit status 1 where a bound of the job does not hold: floor_tolerance (gouge),\n"
        "plan_tolerance (walls), scallop (on 99 % of what the tools reach; what stands on the "
        "rest\n"
        "may be no thicker than scallop and floor_tolerance), or where a rapid move cuts metal.");
    auto options = std::make_shared<VerifyOptions>();
    command->add_option("JOB", options->job, "job file (TOML)")->required();
    command->add_option("PROGRAM", options->program, "G-code")->required();
    command->add_option("--stats", options->stats, "figures to write (JSON)");
    command
        ->add_option("--grid", options->pitch,
                     "mm between the heights looked at (default 0.173 or finer)")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--step", options->spacing, "mm between tool positions (default 0.1 or finer)")
        ->check(CLI::PositiveNumber);
    command->add_option("--path-picture", options->path_picture,
                        "picture to write (SVG): the path from above, coloured by height");
    command->add_option("--left-picture", options->left_picture,
                        "picture to write (SVG): what is left over the floor");
    command->callback([&work, options] {
        work = [options] {
            return run_verify(*options);
        };
    });
}

}  // namespace cusp::cli
