// Parses the listings.
#include "host_tools/controller/stream/controller_facts.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "firmware/machine/tool_changer.hpp"
#include "host_tools/controller/dialect/leading_number.hpp"

namespace cusp::stream {
namespace {

using machine::Setting;

template <class Number>
std::optional<Number> number_in(std::string_view text)
{
    Number number{};
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    return failed == std::errc{} ? std::optional{number} : std::nullopt;
}

// As std::from_chars, which not every library has for numbers with a point.
std::optional<double> decimal_in(std::string_view text)
{
    const auto number = dialect::leading_number(text);
    return number ? std::optional{number->value} : std::nullopt;
}

// mm; 0 where it is none that a machine has.
double distance_in(std::string_view text)
{
    constexpr double kFarthest = 1e7;
    const double distance = decimal_in(text).value_or(0.0);
    return std::abs(distance) <= kFarthest ? distance : 0.0;
}

Position position_in(std::string_view text)
{
    AxisVecd place;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        place[axis] = distance_in(text);
        const std::size_t comma = text.find(',');
        text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
    }
    return to_position(place);
}

Position in_millimetres(Position inches)
{
    Position place = inches;  // A is degrees
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        place[axis] = inches[axis] * 254 / 10;
    }
    return place;
}

}  // namespace

void ControllerFacts::take(std::string_view line)
{
    if (line.size() > 2 && line.front() == '[' && line.back() == ']') {
        const std::string_view inside = line.substr(1, line.size() - 2);
        const std::size_t colon = inside.find(':');
        if (colon != std::string_view::npos) {
            take_parameter(inside.substr(0, colon), inside.substr(colon + 1));
        }
        return;
    }
    const std::size_t equals = line.find('=');
    if (line.empty() || line.front() != '$' || equals == std::string_view::npos) {
        return;
    }
    const auto number = number_in<std::uint32_t>(line.substr(1));
    const auto value = decimal_in(line.substr(equals + 1));
    if (number && value && std::isfinite(static_cast<float>(*value))) {
        has_settings_ = true;
        machine::Settings changed = settings_;
        if (!changed.put(*number, static_cast<float>(*value))) {
            settings_ = changed;
        }
    }
}

void ControllerFacts::take_parameter(std::string_view name, std::string_view value)
{
    for (std::size_t i = 0; i < gcode::kCoordinateSystemNames.size(); ++i) {
        if (name == gcode::kCoordinateSystemNames[i]) {
            parameters_.work_offsets[i] = position_in(value);
        }
    }
    if (name == "GC") {
        modal_ = std::string{value};
    } else if (name == "G28") {
        parameters_.home = position_in(value);
    } else if (name == "G30") {
        parameters_.second_home = position_in(value);
    } else if (name == "G92") {
        parameters_.coordinate_offset = position_in(value);
    } else if (name == "TLO") {
        parameters_.tool_length_offset_nm = to_nanometres(distance_in(value));
    } else if (name == "T") {
        take_tool(value);
    } else if (name == "OPT") {
        // `OPT:V,15,128`: blocks and bytes.
        const std::size_t comma = value.rfind(',');
        if (comma != std::string_view::npos) {
            constexpr std::size_t kMost = 1 << 16;
            const auto bytes = number_in<std::size_t>(value.substr(comma + 1));
            receive_buffer_ = bytes ? std::optional{std::min(*bytes, kMost)} : std::nullopt;
        }
    }
}

// `2|0.000,0.000,-7.300|0.000`: number, offsets of the axes, radius.
void ControllerFacts::take_tool(std::string_view value)
{
    const auto tool = number_in<unsigned>(value);
    const std::size_t bar = value.find('|');
    if (!tool || !gcode::ToolTable::holds(*tool) || bar == std::string_view::npos) {
        return;
    }
    const std::int64_t length = position_in(value.substr(bar + 1)).z;
    if (gcode::fits_tool_table(length)) {
        parameters_.tools.enter(*tool, length);
    }
}

gcode::Parameters ControllerFacts::parameters() const
{
    gcode::Parameters parameters = parameters_;
    if (!settings_.on(Setting::kReportInches)) {
        return parameters;
    }
    for (Position& offset : parameters.work_offsets) {
        offset = in_millimetres(offset);
    }
    parameters.home = in_millimetres(parameters.home);
    parameters.second_home = in_millimetres(parameters.second_home);
    parameters.coordinate_offset = in_millimetres(parameters.coordinate_offset);
    parameters.tool_length_offset_nm = parameters.tool_length_offset_nm * 254 / 10;
    for (unsigned tool = 1; tool <= gcode::ToolTable::kTools; ++tool) {
        const std::int64_t length = parameters.tools.length_nm(tool) * 254 / 10;
        if (parameters.tools.has(tool) && gcode::fits_tool_table(length)) {
            parameters.tools.enter(tool, length);
        }
    }
    return parameters;
}

TransferStart ControllerFacts::start_at(Position machine) const
{
    return {machine,
            modal_,
            parameters(),
            settings_.axes(),
            settings_.value(Setting::kPathTolerance),
            machine::tool_change_mode(settings_) == machine::ToolChangeMode::kTouchOff};
}

}  // namespace cusp::stream
