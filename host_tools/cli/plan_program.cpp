// Plans all operations, then writes the files.
#include "host_tools/cli/plan_program.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <numeric>
#include <sstream>

#include "firmware/base/inch.hpp"
#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/cli/chip_load.hpp"
#include "host_tools/cli/post_fit.hpp"
#include "host_tools/cli/rapid_lift.hpp"
#include "host_tools/cli/rest_of_job.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/cli/stock_warning.hpp"
#include "host_tools/cli/tool_reach.hpp"
#include "host_tools/controller/simulate/simulated_times.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/geometry/toolpath/post.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"
#include "host_tools/geometry/toolpath/tool_order.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/fixture_clearance.hpp"
#include "host_tools/job/job/level_warnings.hpp"
#include "host_tools/job/job/overlap_warnings.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "nlohmann/json.hpp"

namespace cusp::cli {

using files::write_text;
using job::Job;
using job::kRoughingDone;
using job::level_warnings;
using job::Operation;
using job::overlap_warnings;
using job::PocketRefusal;
using strategies::plan_operation;
using toolpath::end_of;
using toolpath::MachineRates;
using toolpath::PathMeasure;
using toolpath::PlannedOperation;
using toolpath::ProgramForm;
using toolpath::short_tour;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Roughing and finish are planned at once, by two threads that report shares of the same operation.
class PartsProgress {
public:
    PartsProgress(bool roughs, double quiet_s) : roughs_{roughs}, shown_{"planning", quiet_s} {}

    void operator()(double share)
    {
        const std::lock_guard lock{guard_};
        double& part = roughs_ && share <= kRoughingDone ? rough_ : finish_;
        part = std::max(part, share);
        const double begun = roughs_ ? kRoughingDone : 0.0;
        shown_(share >= 1 ? 1.0 : rough_ + std::max(0.0, finish_ - begun));
    }

private:
    std::mutex guard_;
    bool roughs_;
    double rough_{};
    double finish_{};
    ShareProgress shown_;
};

// Leaves out pockets that the tool does not fit into, where a drawing has several.
std::vector<PlannedOperation> planned(const Job& job, const Operation& operation, Plan& plan)
{
    const auto is_of_same_table = [&](const Operation& other) {
        return other.number == operation.number;
    };
    try {
        return plan_operation(job, operation);
    } catch (const PocketRefusal& error) {
        if (std::count_if(job.operations.begin(), job.operations.end(), is_of_same_table) < 2) {
            throw;
        }
        plan.warnings.push_back(std::string{error.what()} + ": left out");
        return {};
    }
}

// The operations of one table that follow each other with one tool, pockets of a drawing, lie beside each
// other: they get a short tour.
//
// pockets  of each operation the one that it belongs to: roughing and finish of a pocket stay in order
void shorten_ways(const std::vector<PlannedOperation>& operations,
                  const std::vector<std::size_t>& pockets,
                  std::vector<std::size_t>& order)
{
    Vec2d here{0, 0};
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
        std::vector<std::vector<std::size_t>> stops;
        std::vector<Vec2d> starts;
        for (end = first; end < order.size(); ++end) {
            const PlannedOperation& a = operations[order[first]];
            const PlannedOperation& b = operations[order[end]];
            if (a.operation != b.operation || a.path.tool.number != b.path.tool.number ||
                b.path.moves.empty()) {
                break;
            }
            if (stops.empty() || pockets[stops.back().back()] != pockets[order[end]]) {
                stops.emplace_back();
                starts.push_back(in_plan(end_of(b.path.moves.front())));
            }
            stops.back().push_back(order[end]);
        }
        std::size_t place = first;
        for (const std::size_t k : short_tour(starts, here)) {
            for (const std::size_t operation : stops[k]) {
                order[place++] = operation;
            }
        }
        end = std::max(end, first + 1);
        if (!operations[order[end - 1]].path.moves.empty()) {
            here = in_plan(end_of(operations[order[end - 1]].path.moves.back()));
        }
    }
}

// Groups the operations by tool.
void put_in_order(const Job& job,
                  std::vector<PlannedOperation>& operations,
                  const std::vector<std::size_t>& pockets,
                  Plan& plan)
{
    std::vector<std::size_t> order(operations.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (job.group_by_tool) {
        order = tool_order(operations, job.stock_top + job.clearance);
    }
    shorten_ways(operations, pockets, order);
    for (const std::size_t place : order) {
        plan.operations.push_back(std::move(operations[place]));
    }
}

void measure_in_order(const Job& job, const MachineRates& rates, Plan& plan)
{
    // the position of the tool is unknown before the first rapid move
    Vec3d at{0, 0, job.stock_top + job.clearance};
    for (const PlannedOperation& operation : plan.operations) {
        plan.measures.push_back(measure(operation.path, at, rates));
        at = plan.measures.back().end;
    }
}

Plan plan_job(Job& job, RestOfJob& rest, std::FILE* said)
{
    constexpr double kQuiet = 0.5;  // s
    Plan plan;
    std::vector<PlannedOperation> operations;
    std::vector<std::size_t> pockets;  // places in job.operations
    for (std::size_t i = 0; i < job.operations.size(); ++i) {
        Operation& operation = job.operations[i];
        fmt::print(said, "operation {} of {}: {}\n", i + 1, job.operations.size(),
                   operation.strategy);
        std::fflush(said);
        const auto begin = std::chrono::steady_clock::now();
        cancellation::set_work(fmt::format("planning operation {} of {} ({}) of {}", i + 1,
                                           job.operations.size(), operation.strategy, job.file));
        const auto progress = std::make_shared<PartsProgress>(operation.roughing, kQuiet);
        job.progress = [progress](double share) {
            (*progress)(share);
        };
        std::vector<PlannedOperation> results =
            rest.rest_of(job, operation, [&] { return planned(job, operation, plan); });
        job.report_progress(1.0);
        const double seconds = seconds_since(begin) / static_cast<double>(results.size());
        for (PlannedOperation& result : results) {
            if (result.path.moves.empty() && !result.stats.rest) {
                const auto& why = result.stats.warnings;
                plan.warnings.insert(plan.warnings.end(), why.begin(), why.end());
                continue;
            }
            if (result.stats.planning_s <= 0) {
                result.stats.planning_s = seconds;
            }
            result.stats.retracts += keep_off_fixtures(
                job, fmt::format("operation {}, {}", operation.number, operation.strategy),
                result.path);
            add_rounding(job, result);
            result.operation = operation.number;
            operations.push_back(std::move(result));
            pockets.push_back(i);
        }
    }
    put_in_order(job, operations, pockets, plan);
    return plan;
}

// Replaces the estimates of `measure` by simulated times, except in very long programs: a day of
// machine time takes a minute to simulate.
void put_simulated_times(const std::string& program,
                         const std::vector<std::size_t>& begins,
                         Plan& plan)
{
    constexpr double kLongest = 12 * 3600;  // s
    double measured = 0;
    for (const PathMeasure& measure : plan.measures) {
        measured += measure.estimated_s;
    }
    if (measured > kLongest) {
        return;
    }
    constexpr double kQuiet = 2.0;  // s
    cancellation::set_work("timing the program");
    const ShareProgress timing{"timing", kQuiet};
    if (const auto seconds = simulate::simulated_times(program, begins, timing)) {
        for (std::size_t i = 0; i < plan.measures.size(); ++i) {
            plan.measures[i].estimated_s = (*seconds)[i];
        }
    }
}

// The G-code. Sets the times in the plan to those on the controller.
std::string program_of(const Job& job,
                       const std::string& title,
                       const PlanOutput& output,
                       const MachineRates& rates,
                       Plan& plan)
{
    ProgramForm form{
        "cusp " CUSP_VERSION ", " + title, job.inch, job.stock_top + job.clearance, {}, job.post};
    if (job.setup) {
        form.work_offset = job.setup->offset;
    }
    if (output.blend > 0) {
        form.blend_tolerance = output.blend * (job.inch ? kMillimetresPerInch : 1.0);
    }
    std::string program;
    const auto write = [&] {
        std::ostringstream lines;
        const std::vector<std::size_t> begins = write_program(lines, form, plan.operations);
        program = lines.str();
        put_simulated_times(program, begins, plan);
    };
    if (wants_engagement(job, !output.stats.empty())) {
        put_feeds_by_load(job, rates, plan, write);
    } else {
        write();
    }
    return program;
}

void write_plan(const Job& job,
                const std::string& program,
                const PlanOutput& output,
                const Plan& plan)
{
    const cancellation::FinishOutput finish;
    write_text(output.program, program);
    if (!output.stats.empty()) {
        nlohmann::ordered_json about{
            {"job", job.file}, {"units", job.inch ? "inch" : "mm"}, {"bytes", program.size()}};
        if (job.setup) {
            about["setup"] = job.setup->name;
            about["offset"] = fmt::format("G{}", job.setup->offset);
        }
        if (!job.notes.empty()) {
            about["notes"] = job.notes;
        }
        write_text(output.stats, json_text::written(plan_statistics(plan, about), 1) + "\n");
    }
}

}  // namespace

Plan plan_program(Job& job, const std::string& title, const PlanOutput& output)
{
    MachineRates rates;
    rates.exact_stop = !(output.blend > 0);
    check_post(job, output.blend);
    leave_room_for_rounding(job);
    RestOfJob rest{job};
    Plan plan = plan_job(job, rest, output.said);
    if (plan.operations.empty()) {
        throw InputError(fmt::format("{}: there is nothing to cut: {}", job.file,
                                     fmt::join(plan.warnings, "; ")));
    }
    lift_rapids(job, plan);
    measure_in_order(job, rates, plan);
    refuse_contacts(job, plan);
    if (const auto warning = stock_warning(job, plan)) {
        plan.warnings.push_back(*warning);
    }
    for (const std::vector<std::string>& more :
         {overlap_warnings(job), level_warnings(job), reach_warnings(job, plan)}) {
        plan.warnings.insert(plan.warnings.end(), more.begin(), more.end());
    }
    write_plan(job, program_of(job, title, output, rates, plan), output, plan);
    return plan;
}

}  // namespace cusp::cli
