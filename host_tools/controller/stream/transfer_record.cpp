// The record as JSON; lengths in nanometres, exact.
#include "host_tools/controller/stream/transfer_record.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/json_text/json_text.hpp"

namespace cusp::stream {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(Position at)
{
    Json place = Json::array();
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        place.push_back(at[axis]);
    }
    return place;
}

// Records of earlier versions have no A.
Position position_of(const Json& json)
{
    Position at;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        const bool has = axis < kLinearAxes || axis < json.size();
        at[axis] = has ? json.at(axis).get<std::int64_t>() : 0;
    }
    return at;
}

Json json_of(const gcode::Parameters& parameters)
{
    Json offsets = Json::array();
    for (const Position& offset : parameters.work_offsets) {
        offsets.push_back(json_of(offset));
    }
    Json tools = Json::object();
    for (unsigned tool = 1; tool <= gcode::ToolTable::kTools; ++tool) {
        if (parameters.tools.has(tool)) {
            tools[std::to_string(tool)] = parameters.tools.length_nm(tool);
        }
    }
    return {{"work_offsets", offsets},
            {"G28", json_of(parameters.home)},
            {"G30", json_of(parameters.second_home)},
            {"G92", json_of(parameters.coordinate_offset)},
            {"tool_length", parameters.tool_length_offset_nm},
            {"tools", tools}};
}

gcode::Parameters parameters_of(const Json& json)
{
    gcode::Parameters parameters;
    for (std::size_t i = 0; i < parameters.work_offsets.size(); ++i) {
        parameters.work_offsets[i] = position_of(json.at("work_offsets").at(i));
    }
    parameters.home = position_of(json.at("G28"));
    parameters.second_home = position_of(json.at("G30"));
    parameters.coordinate_offset = position_of(json.at("G92"));
    parameters.tool_length_offset_nm = json.at("tool_length").get<std::int64_t>();
    // Records of earlier versions have no table.
    const Json tools = json.value("tools", Json::object());
    for (unsigned tool = 1; tool <= gcode::ToolTable::kTools; ++tool) {
        if (const auto found = tools.find(std::to_string(tool)); found != tools.end()) {
            parameters.tools.enter(tool, found->get<std::int64_t>());
        }
    }
    return parameters;
}

Json json_of(const TransferRecord& record)
{
    return {{"executed_line", record.executed_line},
            {"ending", record.ending},
            {"last_seen_nm", json_of(record.last_seen)},
            {"checked_line", record.checked_line},
            {"crc", record.crc},
            {"start",
             {{"machine_nm", json_of(record.start.machine)},
              {"modal", record.start.modal},
              {"axes", record.start.axes},
              {"default_tolerance_mm", record.start.default_tolerance},
              {"touches_off", record.start.touches_off},
              {"parameters_nm", json_of(record.start.parameters)}}}};
}

TransferRecord record_of(const Json& json)
{
    TransferRecord record;
    record.executed_line = json.at("executed_line").get<std::uint64_t>();
    record.ending = json.at("ending").get<std::string>();
    record.last_seen = position_of(json.at("last_seen_nm"));
    record.checked_line = json.at("checked_line").get<std::uint64_t>();
    record.crc = json.at("crc").get<std::uint32_t>();
    const Json& start = json.at("start");
    record.start.machine = position_of(start.at("machine_nm"));
    record.start.modal = start.at("modal").get<std::string>();
    record.start.axes = start.value("axes", kLinearAxes);
    record.start.default_tolerance = start.at("default_tolerance_mm").get<float>();
    record.start.touches_off = start.value("touches_off", false);
    record.start.parameters = parameters_of(start.at("parameters_nm"));
    return record;
}

}  // namespace

std::string record_file(const std::string& program) { return program + ".resume"; }

bool write_record(const std::string& program, const TransferRecord& record)
{
    const std::string fresh = record_file(program) + ".new";
    {
        std::ofstream out{fresh};
        out << json_text::written(json_of(record), 1) << "\n";
        out.close();
        if (!out) {
            return false;
        }
    }
    std::error_code failed;
    std::filesystem::rename(fresh, record_file(program), failed);
    return !failed;
}

std::optional<TransferRecord> read_record(const std::string& program)
{
    const std::string file = record_file(program);
    std::ifstream in{file};
    if (!in) {
        return std::nullopt;
    }
    try {
        return record_of(Json::parse(in));
    } catch (const Json::exception& error) {
        throw InputError{file + ": is no record of a transfer: " + error.what()};
    }
}

void drop_record(const std::string& program)
{
    std::error_code ignored;
    std::filesystem::remove(record_file(program), ignored);
}

}  // namespace cusp::stream
