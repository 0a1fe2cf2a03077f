// Declares the options. Values are checked when the job is built: the unit is known then.
#include "host_tools/cli/one_line_options.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/one_line_check.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/placing.hpp"
#include "host_tools/job/import/sheet_job.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::cli {

using import::is_part_file;
using import::OneLineRequest;
using import::path_ending;

namespace {

constexpr const char* kGroup = "Without a job file";

bool is_part(const std::string& file)
{
    return is_part_file(file) || import::is_drawing_name(file);
}

bool is_job_file(const std::string& file) { return path_ending(file) == ".toml"; }

// CLI11 takes files after `--tool ball:6` for tools.
void take_files_from_tools(PlanCall& call)
{
    std::vector<std::string>& tools = call.request.tools;
    for (const std::string& text : tools) {
        if (!text.empty() && text.front() == '-') {
            throw InputError("--tool: a tool is missing before " + text + ", such as ball:6");
        }
    }
    const auto files = std::stable_partition(
        tools.begin(), tools.end(),
        [](const std::string& text) { return !is_part(text) && !is_job_file(text); });
    call.files.insert(call.files.end(), files, tools.end());
    tools.erase(files, tools.end());
}

const CLI::Option* option_for_parts(const CLI::App& command)
{
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group() == kGroup && option->count() > 0) {
            return option;
        }
    }
    return nullptr;
}

std::vector<std::string> one_line_strategies()
{
    std::vector<std::string> names;
    for (const job::Strategy* const strategy : strategies::all()) {
        if (strategy->traits.one_line) {
            names.push_back(strategy->name);
        }
    }
    return names;
}

void add_drawing_options(CLI::App& command, OneLineRequest& request)
{
    const auto add = [&](const char* name, auto& value, const char* text) {
        return command.add_option(name, value, text)->group(kGroup);
    };
    add("--depth", request.depth, "of a drawing's outlines and holes, below the stock's top");
    add("--layer", request.layers,
        "NAME=OPERATION or NAME=OPERATION:DEPTH for a layer of a drawing: pocket, drill, engrave, "
        "v_carve, chamfer, profile, outside, inside, on, none; may be repeated")
        ->allow_extra_args(false)
        ->type_name("NAME=OPERATION");
    add("--tabs", request.tabs, "that hold a drawing's outlines: COUNT or COUNT:WIDTH:HEIGHT")
        ->type_name("TABS");
    add("--side", request.side, "of a drawing's outlines: outside (the default), inside, on")
        ->check(CLI::IsMember({"outside", "inside", "on"}))
        ->type_name("SIDE");
    add("--join-gaps", request.join_gaps, "largest gap between lines of a drawing that is closed");
}

}  // namespace

std::string PlanCall::job_name() const
{
    return is_one_line() ? "one-line job of " + request.parts.front() : files.front();
}

void add_one_line_options(CLI::App& command, PlanCall& call)
{
    OneLineRequest& request = call.request;
    const auto add = [&](const char* name, auto& value, const std::string& text) {
        return command.add_option(name, value, text)->group(kGroup);
    };
    add("--tool", request.tools,
        "ball:6, flat:8, bull:10:1.5, drill:5, vee:6:60: the first roughs, the last finishes")
        ->type_name("SHAPE:DIAMETER ...");
    add("--scallop", request.scallop, "height of the scallops that may remain, tolerance included");
    add_drawing_options(command, request);
    add("--units", call.units,
        "unit of the options, the G-code, and .json, .stl and .obj files, which have no unit")
        ->check(CLI::IsMember({"mm", "inch"}))
        ->capture_default_str();
    add("--boundary", request.boundary, "loop round a pocket (.json, .dxf, plate.dxf#layer)");
    add("--island", request.islands, "loop of an island in the pocket; may be repeated")
        ->allow_extra_args(false);
    add("--feed", request.feed, "length a minute; default 200 diameters, at most 1200 mm")
        ->type_name("FEED");
    add("--plunge-feed", request.plunge_feed, "default: a quarter of the feed")->type_name("FEED");
    add("--spindle", request.spindle, "default 12000")->type_name("RPM");
    add("--max-depth", request.max_depth, "of a roughing layer; default: half the diameter");
    add("--allowance", request.allowance,
        "stock that roughing leaves; default: 0.05 diameters, at most 0.3 mm");
    add("--tolerance", request.tolerance, "default: half the scallop, at most 0.01 mm");
    add("--stock-top", request.stock_top, "z; default: the part's top");
    add("--clearance", request.clearance, "height of rapid moves above the stock; default 5 mm");
    add("--scale", request.scale, "of the parts, such as 25.4");
    add("--up", request.up,
        "the file's axis that points up: +x, +y, +z; --up=-y for one that points down")
        ->check(CLI::IsMember(import::kUpAxes))
        ->type_name("AXIS");
    add("--rotate", request.rotate, "degrees about z, or about x,y,z; after --up")
        ->delimiter(',')
        ->expected(1, 3)
        ->allow_extra_args(false)
        ->type_name("DEGREES");
    add("--origin", request.origin,
        "corner, centre, top: the point of the part at 0; its top is z = 0 with each")
        ->check(CLI::IsMember(import::kOrigins))
        ->type_name("PLACE");
    add("--move", request.move, "by x,y,z, after --origin")
        ->delimiter(',')
        ->expected(3)
        ->allow_extra_args(false)
        ->type_name("X,Y,Z");
    add("--strategy", request.strategy,
        fmt::format("{}; pockets need --boundary", fmt::join(one_line_strategies(), ", ")))
        ->check(CLI::IsMember(one_line_strategies()))
        ->type_name("NAME");
    add("--moves", request.output, "lines, arcs or nurbs")
        ->check(CLI::IsMember({"lines", "arcs", "nurbs"}))
        ->type_name("NAME");
    command.add_flag("--no-roughing", call.no_roughing, "only finish")->group(kGroup);
    command
        .add_flag("--print-job", call.print_job,
                  "print the job file that is equivalent to the call")
        ->group(kGroup);
}

void sort_call(const CLI::App& command, PlanCall& call)
{
    take_files_from_tools(call);
    if (call.files.empty()) {
        throw InputError("plan: a job file or a part is required; see cusp plan --help");
    }
    const CLI::Option* option = option_for_parts(command);
    const auto job = std::find_if(call.files.begin(), call.files.end(), is_job_file);
    if (job != call.files.end()) {
        if (call.files.size() > 1) {
            throw InputError(*job + ": is a job, which names its own parts: plan it alone");
        }
        if (option != nullptr) {
            throw InputError(option->get_name() + ": is for parts without a job file; " + *job +
                             " has a key for it (docs/job_file.md)");
        }
        return;
    }
    if (call.files.size() == 1 && option == nullptr && !is_part(call.files.front())) {
        return;  // a job with another ending
    }
    call.request.parts = call.files;
    call.request.inch = call.units == "inch";
    call.request.roughing = !call.no_roughing;
}

}  // namespace cusp::cli
