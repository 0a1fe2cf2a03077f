// cusp plan: from a job file, or from parts and tools, to G-code and its statistics.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/console_watcher.hpp"
#include "host_tools/cli/one_line_options.hpp"
#include "host_tools/cli/resource_options.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/import/job_schema.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/import/post_reader.hpp"
#include "host_tools/job/job/job.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using job::Job;
using plan::PlanOptions;

namespace {

struct PlanFiles {
    std::string program;      // G-code to write
    std::string stats;        // JSON to write; empty: none
    std::FILE* said{stdout};  // receives the lines for people
};

struct PlanArguments {
    const CLI::App* command{};
    PlanCall call;
    PlanFiles output;
    double blend{};  // in the job's units: G64 P; 0: the exact path
    bool estimates_times{false};
    Resources resources;
    bool list_posts{};
    bool schema{false};
    bool help_job{false};
    std::string help_name;  // of a strategy or table; "": all of them
};

// True if the call asks for words on jobs alone, which are printed.
bool explain_jobs(const PlanArguments& options)
{
    if (options.schema) {
        fmt::print("{}", import::job_schema(strategies::all()));
    } else if (options.help_job) {
        fmt::print("{}", options.help_name.empty()
                             ? import::job_help(strategies::all())
                             : import::job_help(strategies::all(), options.help_name));
    }
    if (options.list_posts) {
        for (const toolpath::Post& post : import::all_posts()) {
            fmt::print("{}: {}\n", post.name, import::post_text(post));
        }
    }
    return options.schema || options.help_job || options.list_posts;
}

// Builds the job from parts and options, prints it, and reads it as if it were a file.
Job one_line_job_of(const PlanArguments& options)
{
    import::PartFiles parts;
    const import::OneLineJob job = one_line_job(options.call.request, strategies::all(), parts);
    for (const std::string& line : job.said) {
        fmt::print(options.output.said, "{}\n", line);
    }
    std::fflush(options.output.said);
    if (options.call.print_job) {
        fmt::print("{}", job.toml);
    }
    return import::read_job({job.toml, options.call.job_name(), ""}, strategies::all(), parts);
}

void write_files(const Job& job, const plan::PlannedProgram& program, const PlanFiles& files)
{
    const cancellation::FinishOutput finish;
    files::write_text(files.program, program.gcode);
    write_wanted(files.stats, [&] { return plan::statistics_json(job, program); });
}

// A program for each; those before it have made the stock of the later ones.
void plan_files(std::vector<Job>& setups, const PlanOptions& common, const PlanFiles& files)
{
    ConsoleWatcher watcher{files.said};
    const bool several = setups.size() > 1;
    const auto files_of = [&](const Job& job) {
        PlanFiles own = files;
        if (several) {
            own.program = file_of_setup(files.program, *job.setup);
            own.stats = file_of_setup(files.stats, *job.setup);
        }
        return own;
    };
    std::vector<std::string>
        unsaid;  // notes of the job that is planned: a refusal may come of what they say
    const auto plan_all = [&] {
        plan::plan_setups(
            setups, watcher,
            [&](const Job& job) {
                unsaid = job.notes;
                PlanOptions options = common;
                options.name = files_of(job).program;
                options.measures_engagement = !files.stats.empty();
                if (job.setup) {
                    options.title += ", " + description_of(*job.setup);
                    fmt::print(files.said, "{}\n", description_of(*job.setup));
                }
                return options;
            },
            [&](const Job& job, const plan::PlannedProgram& program) {
                const PlanFiles own = files_of(job);
                write_files(job, program, own);
                fmt::print(own.said, "{}", plan::summary_text(program));
                print_warnings(job.notes);
                unsaid.clear();
                print_warnings(program.all_warnings());
                fmt::print(own.said, "wrote {}\n", own.program);
            });
    };
    try {
        plan_all();
    } catch (const InputError&) {
        print_warnings(unsaid);
        throw;
    }
}

int run_plan(PlanArguments& options)
{
    const PlanCall& call = options.call;
    if (options.output.program.empty() && !call.print_job) {
        throw InputError("plan: -o is required: the G-code to write, such as -o part.ngc");
    }
    apply(options.resources);
    cancellation::set_work("reading " + call.job_name());
    // the standard output of --print-job is the job alone
    options.output.said = call.print_job ? stderr : stdout;
    std::vector<Job> setups;
    if (call.is_one_line()) {
        setups.push_back(one_line_job_of(options));
    } else {
        setups = import::read_setups(call.files.front(), strategies::all(), call.request.machine);
    }
    cancellation::
        return_freed_memory();  // Open CASCADE's shapes take more than what is read of them
    for (Job& job : setups) {
        if (!call.request.post.empty()) {
            job.post = import::read_post(call.request.post, "");
        }
    }
    if (!options.output.program.empty()) {
        PlanOptions common;
        common.title = (call.is_one_line() ? "" : "job ") + call.job_name();
        common.blend = options.blend;
        common.runs_program = !options.estimates_times;
        plan_files(setups, common, options.output);
    }
    return kDone;
}

int run_call(PlanArguments& options)
{
    options.help_job = options.command->count("--help-job") > 0;
    if (explain_jobs(options)) {
        return kDone;
    }
    sort_call(*options.command, options.call);
    return run_plan(options);
}

void add_explaining_options(CLI::App& command, PlanArguments& options)
{
    command
        .add_option("--help-job", options.help_name,
                    "list the strategies and tables of a job file, or the keys of one, and end")
        ->type_name("[NAME]")
        ->expected(0, 1);
    command.add_flag("--schema", options.schema,
                     "print a JSON Schema of job files, for editors, and end");
    command.add_flag("--list-posts", options.list_posts,
                     "say for which controllers programs are written, and what they hold, and end");
}

void add_controller_options(CLI::App& command, PlanArguments& options)
{
    command
        .add_option("--post", options.call.request.post,
                    "the controller to write for: cusp, grbl, linuxcnc ... (--list-posts), or a "
                    "file .toml (docs/posts.md); default: the job's")
        ->type_name("NAME");
    command
        .add_option("--machine", options.call.request.machine,
                    "the machine's file (.toml): its travel, rates and spindle bound the program, "
                    "its post is the "
                    "default (docs/posts.md); default: the job's")
        ->type_name("FILE");
    command
        .add_option("--blend", options.blend,
                    "let the controller round corners by this much, in the job's units (G64 P); "
                    "default: the exact path (G61)")
        ->check(CLI::NonNegativeNumber);
    command.add_flag(
        "--estimate-times", options.estimates_times,
        "quicker: times are estimates by feeds and accelerations, not those of the program "
        "run through the controller's core");
}

}  // namespace

void add_plan_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand("plan", "plan a job, or parts and tools, and write G-code");
    command->footer(
        "Without a job file:\n"
        "  cusp plan part.step --tool ball:6 --scallop 0.02 -o part.ngc\n"
        "  cusp plan part.stl --tool flat:8 ball:6 --scallop 0.05 --feed 800 -o part.ngc\n"
        "  cusp plan floor.json --boundary plate.dxf#outline --island boss.json --tool ball:12 \\\n"
        "            --scallop 0.4 -o pocket.ngc\n"
        "  cusp plan plate.dxf --tool flat:3 drill:5 --depth 6 --layer text=engrave:0.3 -o "
        "plate.ngc\n"
        "It prints the values it chose. --print-job instead of -o prints the job file, to edit "
        "and\n"
        "plan: ... --print-job > part.toml\n\n"
        "--help-job lists the strategies. Statistics are in mm and s, whatever the job's units.\n\n"
        "A job (keys: docs/job_file.md, choice of a strategy: docs/strategies.md):\n"
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
        "  floor = [\"part.step\"]           # .json, .step, .igs, .brep, .stl, .obj, .3mf, .png\n"
        "  scallop = 0.02                  # tolerance included\n"
        "  floor_tolerance = 0.01\n"
        "  output = \"arcs\"                 # \"lines\", \"nurbs\"\n"
        "Pockets (contour_pocket, grid_pocket) add boundary = \"outline.dxf\", islands = [...];\n"
        "max_depth makes layers.\n"
        "A job with several set-ups gives a program for each: part-NAME.ngc.");
    auto options = std::make_shared<PlanArguments>();
    command->add_option(
        "JOB", options->call.files,
        "job file (.toml), or parts: .json, .step, .iges, .brep, .stl, .obj, .3mf, .png; "
        "drawings: .dxf, .svg, Gerber (.gbr), Excellon (.drl)");
    command->add_option("-o,--output", options->output.program, "G-code to write");
    command->add_option("--stats", options->output.stats, "statistics to write (JSON)");
    add_controller_options(*command, *options);
    add_explaining_options(*command, *options);
    add_resource_options(*command, options->resources);
    add_one_line_options(*command, options->call);
    options->command = command;
    run_when_called(*command, work, options, run_call);
}

}  // namespace cusp::cli
