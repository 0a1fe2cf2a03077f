// cusp plan: from a job file to G-code and its statistics.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <sstream>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/cli/strategies.hpp"
#include "host_tools/import/import.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/simulate/text_file.hpp"
#include "host_tools/toolpath/gcode_writer.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::cli {

using import::read_job;
using job::Job;
using job::Operation;
using simulate::write_text;
using toolpath::MachineRates;
using toolpath::MoveCounts;
using toolpath::OperationStats;
using toolpath::PathMeasure;
using toolpath::PlannedOperation;
using toolpath::ProgramForm;

namespace {

using Json = nlohmann::ordered_json;

struct PlanOptions {
    std::string job;
    std::string output;
    std::string stats;
    double blend{};
};

struct Plan {
    std::vector<PlannedOperation> operations;
    std::vector<PathMeasure> measures;
};

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// The job only learns whom to tell of its progress: a copy of large meshes takes much memory.
Plan plan_job(Job& job, const MachineRates& rates)
{
    constexpr double kQuiet = 0.5;  // s
    Plan plan;
    // where the tool stands is not known before the first rapid move
    Vec3d at{0, 0, job.stock_top + job.clearance};
    for (std::size_t i = 0; i < job.operations.size(); ++i) {
        const Operation& operation = job.operations[i];
        fmt::print("operation {} of {}: {}\n", i + 1, job.operations.size(), operation.strategy);
        std::fflush(stdout);
        const auto begin = std::chrono::steady_clock::now();
        job.progress = ShareProgress{"planning", kQuiet};
        std::vector<PlannedOperation> planned = plan_operation(job, operation);
        job.report_progress(1.0);
        const double seconds = seconds_since(begin) / static_cast<double>(planned.size());
        for (PlannedOperation& result : planned) {
            if (result.stats.planning_s <= 0) {
                result.stats.planning_s = seconds;
            }
            plan.measures.push_back(measure(result.path, at, rates));
            at = plan.measures.back().end;
            plan.operations.push_back(std::move(result));
        }
    }
    return plan;
}

Json moves_of(const MoveCounts& moves)
{
    return {{"lines", moves.lines},
            {"arcs", moves.arcs},
            {"nurbs", moves.nurbs},
            {"rapids", moves.rapids}};
}

Json operation_stats(const PlannedOperation& operation, const PathMeasure& measured)
{
    const OperationStats& stats = operation.stats;
    Json out{{"strategy", stats.strategy},
             {"tool", operation.path.tool.number},
             {"passes", stats.passes},
             {"levels", stats.levels},
             {"cl_points", stats.cl_points},
             {"moves", moves_of(measured.moves)},
             {"cut_length_mm", measured.cut_length_mm},
             {"link_length_mm", measured.link_length_mm},
             {"rapid_length_mm", measured.rapid_length_mm},
             {"retracts", stats.retracts},
             {"planning_s", stats.planning_s},
             {"gouge_bound_mm", stats.gouge_bound_mm},
             {"scallop_bound_mm", stats.scallop_bound_mm},
             {"estimated_s", measured.estimated_s}};
    for (const auto& [name, value] : stats.counts) {
        const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
        out[name] = whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
    }
    if (!stats.warnings.empty()) {
        out["warnings"] = stats.warnings;
    }
    return out;
}

// What holds for the whole program, under the same names as for an operation.
Json totals(const Plan& plan)
{
    MoveCounts moves;
    PathMeasure sum;
    OperationStats stats;
    const bool finished = std::any_of(plan.operations.begin(), plan.operations.end(),
                                      [](const auto& o) { return !o.stats.roughing; });
    for (std::size_t i = 0; i < plan.operations.size(); ++i) {
        const PathMeasure& m = plan.measures[i];
        moves.lines += m.moves.lines;
        moves.arcs += m.moves.arcs;
        moves.nurbs += m.moves.nurbs;
        moves.rapids += m.moves.rapids;
        sum.cut_length_mm += m.cut_length_mm;
        sum.rapid_length_mm += m.rapid_length_mm;
        sum.estimated_s += m.estimated_s;
        const OperationStats& s = plan.operations[i].stats;
        stats.passes += s.passes;
        stats.levels += s.levels;
        stats.cl_points += s.cl_points;
        stats.retracts += s.retracts;
        stats.planning_s += s.planning_s;
        stats.gouge_bound_mm = std::max(stats.gouge_bound_mm, s.gouge_bound_mm);
        if (!finished || !s.roughing) {
            stats.scallop_bound_mm = std::max(stats.scallop_bound_mm, s.scallop_bound_mm);
        }
    }
    return {{"strategy", plan.operations.front().stats.strategy},
            {"passes", stats.passes},
            {"levels", stats.levels},
            {"cl_points", stats.cl_points},
            {"moves", moves_of(moves)},
            {"cut_length_mm", sum.cut_length_mm},
            {"rapid_length_mm", sum.rapid_length_mm},
            {"retracts", stats.retracts},
            {"planning_s", stats.planning_s},
            {"gouge_bound_mm", stats.gouge_bound_mm},
            {"scallop_bound_mm", stats.scallop_bound_mm},
            {"estimated_s", sum.estimated_s}};
}

void print_summary(const Plan& plan,
                   const std::vector<std::string>& notes,
                   const std::string& output)
{
    const Json all = totals(plan);
    fmt::print("cut {:.1f} mm, rapid {:.1f} mm, {} retracts; about {:.0f} s\n",
               all["cut_length_mm"].get<double>(), all["rapid_length_mm"].get<double>(),
               all["retracts"].get<int>(), all["estimated_s"].get<double>());
    fmt::print("gouge at most {:.4f} mm, scallop at most {:.4f} mm; planned in {:.2f} s\n",
               all["gouge_bound_mm"].get<double>(), all["scallop_bound_mm"].get<double>(),
               all["planning_s"].get<double>());
    for (const std::string& note : notes) {
        fmt::print(stderr, "cusp: warning: {}\n", note);
    }
    for (const PlannedOperation& operation : plan.operations) {
        for (const std::string& warning : operation.stats.warnings) {
            fmt::print(stderr, "cusp: warning: {}\n", warning);
        }
    }
    fmt::print("wrote {}\n", output);
}

int run_plan(const PlanOptions& options)
{
    Job job = read_job(options.job);
    MachineRates rates;
    rates.exact_stop = !(options.blend > 0);
    const Plan plan = plan_job(job, rates);
    if (plan.operations.empty()) {
        throw InputError(options.job + ": no operation leaves anything to cut");
    }
    ProgramForm form{
        "cusp " CUSP_VERSION ", job " + options.job, job.inch, job.stock_top + job.clearance, {}};
    if (options.blend > 0) {
        form.blend_tolerance = options.blend * (job.inch ? 25.4 : 1.0);
    }
    std::ostringstream lines;
    write_program(lines, form, plan.operations);
    const std::string program = lines.str();
    write_text(options.output, program);
    if (!options.stats.empty()) {
        Json stats = totals(plan);
        stats["job"] = options.job;
        stats["units"] = job.inch ? "inch" : "mm";
        stats["bytes"] = program.size();
        if (!job.notes.empty()) {
            stats["notes"] = job.notes;
        }
        for (std::size_t i = 0; i < plan.operations.size(); ++i) {
            stats["operations"].push_back(operation_stats(plan.operations[i], plan.measures[i]));
        }
        write_text(options.stats, stats.dump(1) + "\n");
    }
    print_summary(plan, job.notes, options.output);
    return kDone;
}

}  // namespace

void add_plan_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand("plan", "plan the operations of a job and write G-code");
    command->footer(
        "Strategies: contour_pocket, adaptive_isocurve, grid_pocket, hull_rough; for comparison\n"
        "complete_isocurves and parallel_planes. Statistics are in mm and s, whatever the job's\n"
        "units.\n\n"
        "A job, all of whose keys docs/job_file.md tells:\n"
        "  units = \"mm\"\n"
        "  [tool]\n"
        "  shape = \"ball\"                  # \"flat\", \"bull\"\n"
        "  diameter = 6.0\n"
        "  [cutting]\n"
        "  feed = 1200.0                   # a minute\n"
        "  [stock]\n"
        "  top = 0.0\n"
        "  [[operation]]\n"
        "  strategy = \"adaptive_isocurve\"\n"
        "  floor = [\"part.step\"]           # .json, .step, .igs, .stl\n"
        "  scallop = 0.02                  # tolerance included\n"
        "  floor_tolerance = 0.01\n"
        "  output = \"arcs\"                 # \"lines\", \"nurbs\"\n"
        "Pockets (contour_pocket, grid_pocket) add boundary = \"outline.dxf\", islands = [...];\n"
        "layers are asked for by max_depth.");
    auto options = std::make_shared<PlanOptions>();
    command->add_option("JOB", options->job, "job file (TOML)")->required();
    command->add_option("-o,--output", options->output, "G-code to write")->required();
    command->add_option("--stats", options->stats, "statistics to write (JSON)");
    command
        ->add_option("--blend", options->blend,
                     "let the controller round corners by this much, in the job's units (G64 P); "
                     "default: the exact path (G61)")
        ->check(CLI::NonNegativeNumber);
    command->callback([&work, options] {
        work = [options] {
            return run_plan(*options);
        };
    });
}

}  // namespace cusp::cli
