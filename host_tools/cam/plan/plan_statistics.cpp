// Statistics as JSON and as a summary.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/cam/plan/plan.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::plan {

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

void add_measured_to(Json& out, const OperationStats& stats)
{
    if (stats.left_measured_mm) {
        out["left_measured_mm"] = *stats.left_measured_mm;
    }
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
    add_measured_to(out, stats);
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

void add_shares_to(Json& out, const TimeShares& shares)
{
    out["cutting_s"] = shares.cutting;
    out["air_s"] = shares.air;
    out["rapid_s"] = shares.rapid;
}

TimeShares sum_of(const std::vector<TimeShares>& all)
{
    TimeShares sum;
    for (const TimeShares& each : all) {
        sum.cutting += each.cutting;
        sum.air += each.air;
        sum.rapid += each.rapid;
    }
    return sum;
}

// " (cutting 71 %, air 4 %, rapid 25 %)"; "" where they are not known.
std::string shares_text(const PlannedProgram& program)
{
    constexpr double kPercent = 100;
    const TimeShares sum = sum_of(program.shares);
    const double all = sum.cutting + sum.air + sum.rapid;
    return all > 0 ? fmt::format(" (cutting {:.0f} %, air {:.0f} %, rapid {:.0f} %)",
                                 kPercent * sum.cutting / all, kPercent * sum.air / all,
                                 kPercent * sum.rapid / all)
                   : "";
}

// Totals of the program, under the keys of an operation's figures.
Json totals(const PlannedProgram& program)
{
    MoveCounts moves;
    PathMeasure sum;
    OperationStats stats;
    const bool finished = std::any_of(program.operations.begin(), program.operations.end(),
                                      [](const auto& o) { return !o.stats.roughing; });
    for (std::size_t i = 0; i < program.operations.size(); ++i) {
        const PathMeasure& m = program.measures[i];
        moves.lines += m.moves.lines;
        moves.arcs += m.moves.arcs;
        moves.nurbs += m.moves.nurbs;
        moves.rapids += m.moves.rapids;
        sum.cut_length_mm += m.cut_length_mm;
        sum.rapid_length_mm += m.rapid_length_mm;
        sum.estimated_s += m.estimated_s;
        const OperationStats& s = program.operations[i].stats;
        stats.passes += s.passes;
        stats.levels += s.levels;
        stats.cl_points += s.cl_points;
        stats.retracts += s.retracts;
        stats.planning_s += s.planning_s;
        stats.gouge_bound_mm = std::max(stats.gouge_bound_mm, s.gouge_bound_mm);
        if (!finished || !s.roughing) {
            stats.scallop_bound_mm = std::max(stats.scallop_bound_mm, s.scallop_bound_mm);
            stats.left_measured_mm = std::max(stats.left_measured_mm, s.left_measured_mm);
        }
    }
    Json out{{"strategy", program.operations.front().stats.strategy},
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
    add_measured_to(out, stats);
    return out;
}

// How far the bound of the scallop is proved.
std::string words_of_measured(const Json& all)
{
    const auto measured = all.find("left_measured_mm");
    return measured == all.end()
               ? ""
               : fmt::format(" where the end can touch, {:.4f} mm measured elsewhere",
                             measured->get<double>());
}

}  // namespace

std::string summary_text(const PlannedProgram& program)
{
    const Json all = totals(program);
    return fmt::format(
        "cut {:.1f} mm, rapid {:.1f} mm, {}; about {:.0f} s{}\n"
        "gouge at most {:.4f} mm, scallop at most {:.4f} mm{}; planned in {:.2f} s\n",
        all["cut_length_mm"].get<double>(), all["rapid_length_mm"].get<double>(),
        counted(all["retracts"].get<std::size_t>(), "retract"), all["estimated_s"].get<double>(),
        shares_text(program), all["gouge_bound_mm"].get<double>(),
        all["scallop_bound_mm"].get<double>(), words_of_measured(all),
        all["planning_s"].get<double>());
}

std::string statistics_json(const job::Job& job, const PlannedProgram& program)
{
    Json stats = totals(program);
    if (!program.shares.empty()) {
        add_shares_to(stats, sum_of(program.shares));
    }
    stats.update(Json{
        {"job", job.file}, {"units", job.inch ? "inch" : "mm"}, {"bytes", program.gcode.size()}});
    if (job.setup) {
        stats["setup"] = job.setup->name;
        stats["offset"] = fmt::format("G{}", job.setup->offset);
    }
    if (!job.notes.empty()) {
        stats["notes"] = job.notes;
    }
    if (!program.warnings.empty()) {
        stats["warnings"] = program.warnings;
    }
    for (std::size_t i = 0; i < program.operations.size(); ++i) {
        stats["operations"].push_back(operation_stats(program.operations[i], program.measures[i]));
        if (!program.shares.empty()) {
            add_shares_to(stats["operations"].back(), program.shares[i]);
        }
    }
    return json_text::written(stats, 1) + "\n";
}

}  // namespace cusp::plan
