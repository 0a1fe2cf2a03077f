// Statistics as JSON and as a summary.
#include "host_tools/cli/plan_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host_tools/base/input_error/counted.hpp"

#include "fmt/format.h"

namespace cusp::cli {

using toolpath::MoveCounts;
using toolpath::OperationStats;
using toolpath::PathMeasure;
using toolpath::PlannedOperation;

namespace {

using Json = nlohmann::ordered_json;

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
        constexpr double kMostWhole = 1e15;  // more have no exact neighbours
        const bool whole = value == std::floor(value) && std::abs(value) < kMostWhole;
        out[name] = whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
    }
    if (stats.rest) {
        out["rest_machining"] = {{"programs", stats.rest->programs},
                                 {"removed_mm", stats.rest->removed_mm},
                                 {"kept_mm", stats.rest->kept_mm},
                                 {"tolerance_mm", stats.rest->tolerance_mm}};
    }
    if (!stats.warnings.empty()) {
        out["warnings"] = stats.warnings;
    }
    return out;
}

// Totals of the program, under the keys of an operation's figures.
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

void print_warnings(const std::vector<std::string>& warnings)
{
    for (const std::string& warning : warnings) {
        fmt::print(stderr, "cusp: warning: {}\n", warning);
    }
}

}  // namespace

std::vector<const toolpath::Toolpath*> paths_of(const Plan& plan)
{
    std::vector<const toolpath::Toolpath*> paths;
    for (const toolpath::PlannedOperation& operation : plan.operations) {
        paths.push_back(&operation.path);
    }
    return paths;
}

void print_summary(const Plan& plan,
                   const std::vector<std::string>& notes,
                   const std::string& output,
                   std::FILE* said)
{
    const Json all = totals(plan);
    fmt::print(said, "cut {:.1f} mm, rapid {:.1f} mm, {}; about {:.0f} s\n",
               all["cut_length_mm"].get<double>(), all["rapid_length_mm"].get<double>(),
               counted(all["retracts"].get<std::size_t>(), "retract"),
               all["estimated_s"].get<double>());
    fmt::print(said, "gouge at most {:.4f} mm, scallop at most {:.4f} mm; planned in {:.2f} s\n",
               all["gouge_bound_mm"].get<double>(), all["scallop_bound_mm"].get<double>(),
               all["planning_s"].get<double>());
    print_warnings(notes);
    print_warnings(plan.warnings);
    for (const PlannedOperation& operation : plan.operations) {
        print_warnings(operation.stats.warnings);
    }
    fmt::print(said, "wrote {}\n", output);
}

nlohmann::ordered_json plan_statistics(const Plan& plan, const Json& about)
{
    Json stats = totals(plan);
    stats.update(about);
    if (!plan.warnings.empty()) {
        stats["warnings"] = plan.warnings;
    }
    for (std::size_t i = 0; i < plan.operations.size(); ++i) {
        stats["operations"].push_back(operation_stats(plan.operations[i], plan.measures[i]));
    }
    return stats;
}

}  // namespace cusp::cli
