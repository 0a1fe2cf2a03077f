// Declares the options. Values are checked when the job is built: the unit is known then.
#include "host_tools/cli/one_line_options.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/one_line_check.hpp"
#include "host_tools/job/import/one_line_keys.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/sheet_job.hpp"

#include "CLI/CLI.hpp"

namespace cusp::cli {

using import::OneLineKey;

namespace {

constexpr const char* kGroup = "Without a job file";

bool is_part(const std::string& file)
{
    return import::is_part_file(file) || import::is_drawing_name(file);
}

bool is_job_file(const std::string& file) { return import::path_ending(file) == ".toml"; }

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

// Adds the option of a key, whose value is of one of the kinds of OneLineKey::Place.
template <class Value>
void add_option(CLI::App& command, const OneLineKey& key, Value& value)
{
    constexpr bool is_list = std::is_same_v<Value, std::vector<std::string>>;
    CLI::Option* const option = command.add_option(option_of(key), value, key.help)->group(kGroup);
    if (*key.type != '\0') {
        option->type_name(key.type);
    }
    if (!key.choices.empty()) {
        option->check(CLI::IsMember(key.choices));
    }
    if constexpr (std::is_same_v<Value, std::vector<double>>) {
        option->delimiter(',')
            ->expected(key.least_values, key.most_values)
            ->allow_extra_args(false);
    }
    if (is_list && key.place != OneLineKey::Place{&import::OneLineRequest::tools}) {
        option->allow_extra_args(false);
    }
}

}  // namespace

std::string PlanCall::job_name() const
{
    return is_one_line() ? "one-line job of " + request.parts.front() : files.front();
}

void add_one_line_options(CLI::App& command, PlanCall& call)
{
    for (const OneLineKey& key : import::one_line_keys(strategies::all())) {
        std::visit([&](const auto place) { add_option(command, key, call.request.*place); },
                   key.place);
    }
    command
        .add_option(
            "--units", call.units,
            "unit of the options, the G-code, and .json, .stl and .obj files, which have no unit")
        ->check(CLI::IsMember({"mm", "inch"}))
        ->capture_default_str()
        ->group(kGroup);
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
