// Keys are those of `cusp sim --stats` and `cusp verify --stats` where the meaning is equal.
#include "host_tools/judge/view/run_facts.hpp"

#include <cmath>

#include "host_tools/base/json_text/json_text.hpp"

#include "nlohmann/json.hpp"

namespace cusp::view {

using program_run::RunError;
using program_run::ToolTime;
using toolpath::Tool;
using verify::ToolFigures;
using verify::VerifyFigures;

namespace {

using Json = nlohmann::ordered_json;

Json per_axis(Vec3d v) { return Json::array({v.x, v.y, v.z}); }
Json per_axis(Vec3f v)
{
    return per_axis(
        Vec3d{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)});
}

Json optional(std::optional<double> value)
{
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json main_facts(const RunFacts& facts)
{
    const auto& moves = facts.run.moves;
    Json out{{"duration_s", facts.run.duration_s},
             {"moves", moves.rapid + moves.line + moves.arc + moves.nurbs},
             {"ticks", facts.ticks},
             {"length_mm", facts.run.length_mm},
             {"max_velocity", per_axis(xyz(facts.run.max_velocity))},
             {"max_acceleration", per_axis(xyz(facts.run.max_acceleration))},
             {"max_jerk", per_axis(xyz(facts.run.max_jerk))}};
    if (facts.verification != nullptr) {
        out["gouge_max_mm"] = facts.verification->figures.gouge_max;
        out["scallop_max_mm"] = facts.verification->figures.scallop_max;
        out["worst"] = Json::array();
        for (const WorstPlace& place : facts.worst) {
            out["worst"].push_back(
                {{"kind", place.kind}, {"mm", place.mm}, {"at", per_axis(place.at)}});
        }
    }
    return out;
}

Json run_facts(const RunFacts& facts)
{
    const auto& run = facts.run;
    Json errors = Json::array();
    for (const RunError& error : run.errors) {
        errors.push_back({{"line", error.line}, {"code", error.code}, {"text", error.text}});
    }
    return {{"total_s", run.total_s},
            {"lines", run.lines},
            {"rapids", run.moves.rapid},
            {"lines_moved", run.moves.line},
            {"arcs", run.moves.arc},
            {"nurbs", run.moves.nurbs},
            {"max_deviation_mm", run.max_deviation_mm},
            {"max_deviation_line", run.max_deviation_line},
            {"pauses", run.pauses},
            {"alarm", run.alarm},
            {"stopped", run.stopped},
            {"errors", errors}};
}

// The tool above the cutter, if the job describes it.
void add_body(const job::Job& job, const Tool& tool, Json& entry)
{
    const auto found = job.tool_facts.find(tool.number);
    if (found == job.tool_facts.end()) {
        return;
    }
    const job::ToolFacts& facts = found->second;
    if (facts.flute_length) {
        entry["flute_length"] = *facts.flute_length;
    }
    if (facts.length) {
        entry["length"] = *facts.length;
    }
    if (facts.shank_diameter) {
        entry["shank_diameter"] = *facts.shank_diameter;
    }
    if (!facts.holder.empty()) {
        entry["holder"] = facts.holder;
    }
}

Json tools_of(const RunFacts& facts)
{
    Json out = Json::array();
    for (const ToolTime& time : facts.run.tools) {
        Json entry{{"number", time.number}, {"time_s", time.seconds()}};
        if (facts.job != nullptr) {
            const Tool* tool = &facts.job->tools.front();
            for (const Tool& known : facts.job->tools) {
                tool = known.number == time.number ? &known : tool;
            }
            entry["shape"] = name_of(tool->shape);
            entry["radius"] = tool->radius;
            entry["corner_radius"] = tool->corner_radius;
            if (is_conical(*tool)) {
                entry["tip_angle"] = tool->tip_angle;
                entry["tip_radius"] = tool->tip_radius;
            }
            add_body(*facts.job, *tool, entry);
        }
        if (facts.verification != nullptr) {
            for (const ToolFigures& figures : facts.verification->figures.tools) {
                if (figures.tool.number == time.number) {
                    entry["cut_length_mm"] = figures.cut_length;
                    entry["cut_depth_max_mm"] = figures.cut_depth_max;
                }
            }
        }
        out.push_back(std::move(entry));
    }
    return out;
}

Json reading_of(const ProgramReading& reading)
{
    Json refused = Json::array();
    for (const RefusedLine& line : reading.refused) {
        refused.push_back({{"line", line.line},
                           {"begin", line.begin},
                           {"end", line.end},
                           {"code", line.code},
                           {"text", line.text}});
    }
    Json sections = Json::array();
    for (const ProgramSection& section : reading.sections) {
        sections.push_back(
            {{"line", section.line}, {"tool", section.tool}, {"title", section.title}});
    }
    return {{"refused", refused},
            {"refused_count", reading.refused_count},
            {"sections", sections},
            {"header", reading.header}};
}

Json verification_of(const RunFacts& facts)
{
    const VerifyFigures& f = facts.verification->figures;
    const verify::VerifyBounds& bounds = facts.verification->bounds;
    Json out{{"floor_tolerance", bounds.floor_tolerance},
             {"plan_tolerance", bounds.plan_tolerance},
             {"scallop_bound_mm", optional(f.scallop_bound)},
             {"gouge_max_mm", f.gouge_max},
             {"ball_gouge_max_mm", optional(f.ball_gouge_max)},
             {"wall_gouge_max_mm", optional(f.wall_gouge_max)},
             {"rapid_cut_max_mm", f.rapid_cut_max},
             {"rapid_cut_bound_mm", bounds.rapid_cut},
             {"scallop_max_mm", f.scallop_max},
             {"scallop_p99_mm", f.scallop_p99},
             {"uncovered_share", f.uncovered_share},
             {"uncovered_bound", bounds.uncovered_share},
             {"uncut_share", f.uncut_share},
             {"unreachable_share", f.unreachable_share},
             {"cut_depth_max_mm", f.cut_depth_max},
             {"left_volume_mm3", f.left_volume},
             {"broken", facts.verification->broken}};
    if (f.engagement) {
        out["engagement"] = {{"max_deg", f.engagement->angle_max},
                             {"limited_max_deg", optional(f.engagement->limited_max)},
                             {"line", f.engagement->line},
                             {"limit_deg", optional(f.engagement->limit)},
                             {"over_mm", optional(f.engagement->over_length)},
                             {"air_mm", f.engagement->air_length}};
    }
    return out;
}

}  // namespace

std::string facts_json(const RunFacts& facts)
{
    Json json{{"program", facts.program},
              {"job", facts.job != nullptr ? Json(facts.job->file) : Json(nullptr)},
              {"start_us", facts.start_us},
              {"farthest_nm", facts.farthest_nm},
              {"limits",
               {{"velocity", per_axis(xyz(facts.limits.velocity))},
                {"acceleration", per_axis(xyz(facts.limits.acceleration))},
                {"jerk", per_axis(xyz(facts.limits.jerk))}}},
              {"facts", main_facts(facts)},
              {"run", run_facts(facts)},
              {"tools", tools_of(facts)},
              {"reading", reading_of(facts.reading)},
              {"not_verified", facts.not_verified}};
    if (facts.verification != nullptr) {
        json["verification"] = verification_of(facts);
    }
    const std::string text = json_text::written(json);
    // In JSON < occurs in strings only.
    std::string out;
    for (const char c : text) {
        if (c == '<') {
            out += "\\u003c";
        } else {
            out += c;
        }
    }
    return out;
}

}  // namespace cusp::view
