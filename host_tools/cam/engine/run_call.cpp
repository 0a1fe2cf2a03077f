// cusp sim, and the data of cusp view.
#include <utility>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/judge/view/run_page.hpp"

#include "fmt/format.h"

namespace cusp::engine {

using simulate::SimulationOptions;
using simulate::SimulationResult;

namespace {

SimulationOptions options_of(Call& call)
{
    SimulationOptions options;
    if (const auto settings = call.arguments.find_text("settings")) {
        options.settings = simulate::settings_of_text(*settings, "settings");
    }
    const std::string dialect = call.arguments.find_text("dialect").value_or("cusp");
    if (dialect != "cusp" && dialect != "grbl") {
        throw InputError{
            fmt::format("run: dialect: is \"{}\", known are \"cusp\", \"grbl\"", dialect),
            {"", 0, "dialect", dialect, "cusp or grbl"}};
    }
    options.stock_grbl = dialect == "grbl";
    options.progress = [&call](const simulate::SimulationProgress& progress) {
        call.report(progress.fraction, "running");
    };
    return options;
}

Json result_json(const SimulationResult& run, bool good)
{
    Json faults = Json::array();
    for (const program_run::RunError& error : run.errors) {
        faults.push_back({{"line", error.line}, {"text", fault_text(run, error)}});
    }
    return {
        {"good", good}, {"faults", faults}, {"stats", Json::parse(simulate::statistics_json(run))}};
}

// With the data of a page.
Json page_json(Call& call, SimulationOptions simulation, const std::string& program)
{
    view::RunPageOptions options;
    options.simulation = std::move(simulation);
    options.simulation.sums_edges = false;
    std::optional<job::Job> job;
    if (call.arguments.find_text("job")) {
        job = read_job_of_program(call.arguments);
        options.job = &*job;
    }
    call.arguments.check_all_read();
    options.verifying = [&](double share) {
        call.report(share, "cutting " + program);
    };
    view::RunData data = view::run_data(program, options);
    Json result = result_json(data.run, data.good);
    result["facts"] = Json::parse(data.facts);
    result["ticks"] = data.ticks;
    result["refused"] = data.refused;
    result["verdict"] = data.verdict;
    for (view::RunBlock& block : data.blocks) {
        call.blocks.push_back({block.id, std::move(block.bytes)});
    }
    return result;
}

}  // namespace

Json run_call(Call& call)
{
    const std::string program = call.arguments.text("program");
    const bool page = call.arguments.flag("page", true);
    SimulationOptions options = options_of(call);
    if (page) {
        return page_json(call, std::move(options), program);
    }
    call.arguments.check_all_read();
    const SimulationResult run = simulate::simulate(program, options);
    return result_json(run, run.good());
}

}  // namespace cusp::engine
