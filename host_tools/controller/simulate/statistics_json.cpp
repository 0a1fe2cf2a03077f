// The statistics of a run as JSON.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/controller/simulate/simulate.hpp"

namespace cusp::simulate {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of so many axes, X first.
template <class Vector>
Json per_axis(const Vector& vector, unsigned axes)
{
    Json values = Json::array();
    for (unsigned axis = 0; axis < axes; ++axis) {
        values.push_back(vector[axis]);
    }
    return values;
}

}  // namespace

std::string statistics_json(const SimulationResult& result)
{
    Json errors = Json::array();
    for (const program_run::RunError& error : result.errors) {
        errors.push_back({{"line", error.line},
                          {"code", error.code},
                          {"text", error.text},
                          {"block", error.block},
                          {"word", error.word}});
    }
    Json tools = Json::array();
    for (const program_run::ToolTime& tool : result.tools) {
        tools.push_back({{"number", tool.number}, {"time_s", tool.seconds()}});
    }
    const program_run::ProgramMoveCounts& moves = result.moves;
    Json json{
        {"duration_s", result.duration_s},
        {"total_s", result.total_s},
        {"wall_s", result.wall_s},
        {"lines", result.lines},
        {"moves",
         {{"rapid", moves.rapid},
          {"line", moves.line},
          {"arc", moves.arc},
          {"nurbs", moves.nurbs}}},
        {"edges_crc32", fmt::format("{:08x}", result.edges_crc32)},
        {"steps", per_axis(result.steps, result.axes)},
        {"end_mpos_mm", per_axis(to_millimetres(result.end), result.axes)},
        {"length_mm", result.length_mm},
        {"max_velocity", per_axis(result.max_velocity, result.axes)},
        {"max_acceleration", per_axis(result.max_acceleration, result.axes)},
        {"max_jerk", per_axis(result.max_jerk, result.axes)},
        {"max_deviation_mm", result.max_deviation_mm},
        {"max_deviation_line", result.max_deviation_line},
        {"starved_ticks", result.starved_ticks},
        {"alarm", result.alarm == 0 ? Json(nullptr) : Json(result.alarm)},
        {"errors", errors},
        {"pauses", result.pauses},
        {"pause_lines", result.pause_lines},
        {"tools", tools},
        {"tool_changes", result.tool_changes},
    };
    return json_text::written(json, 2) + "\n";
}

}  // namespace cusp::simulate
