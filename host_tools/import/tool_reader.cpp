// Reads the shape first: it determines which lengths a tool has.
#include "host_tools/import/tool_reader.hpp"

#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/import/known_keys.hpp"

#include "fmt/format.h"

namespace cusp::import {

using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// The cone of a vee or a drill.
void read_tip(JobTable& keys, const std::string& shape, double millimetres, Tool& tool)
{
    constexpr Range kTipAngle{1, 179};  // degrees
    constexpr double kTwistDrill = 118;
    const auto angle = keys.number("tip_angle", kTipAngle);
    const auto flat = keys.number("tip_diameter", kNotNegative);
    if (tool.shape == ToolShape::kVee && !angle) {
        keys.refuse("tip_angle",
                    "is missing: a vee tool needs the angle between its flanks, such "
                    "as 60 or 90 degrees");
    }
    if (!is_conical(tool) && angle) {
        keys.refuse("tip_angle", fmt::format("belongs to a vee or a drill, this one is {}", shape));
    }
    if (tool.shape != ToolShape::kVee && flat) {
        keys.refuse("tip_diameter", fmt::format("belongs to a vee tool, this one is {}", shape));
    }
    if (is_conical(tool)) {
        tool.tip_angle = angle.value_or(kTwistDrill) * kPi / 180;
        tool.tip_radius = flat.value_or(0) * millimetres / 2;
    }
    if (is_conical(tool) && tool.tip_radius >= tool.radius) {
        keys.refuse("tip_diameter", fmt::format("is {:g} mm, the tool's diameter is only {:g} mm",
                                                2 * tool.tip_radius, 2 * tool.radius));
    }
}

}  // namespace

Tool read_tool(const toml::table& table,
               const std::string& file,
               std::size_t index,
               double millimetres)
{
    JobTable keys{table, file, fmt::format("tool {}", index), tool_keys()};
    Tool tool;
    tool.number = keys.whole_number("number", kToolNumber).value_or(static_cast<int>(index));
    const std::string shape =
        keys.one_of("shape", {"ball", "flat", "bull", "vee", "drill"}).value_or("");
    if (shape.empty()) {
        keys.refuse("shape", "is missing: \"ball\", \"flat\", \"bull\", \"vee\" or \"drill\"");
    }
    tool.shape = shape == "ball"   ? ToolShape::kBall
                 : shape == "flat" ? ToolShape::kFlat
                 : shape == "bull" ? ToolShape::kBull
                 : shape == "vee"  ? ToolShape::kVee
                                   : ToolShape::kDrill;
    tool.radius = keys.required_number("diameter", kPositive) * millimetres / 2;
    const auto given = keys.number("corner_radius", kPositive);
    const auto corner = given ? std::optional{*given * millimetres} : std::nullopt;
    if (tool.shape == ToolShape::kBull && !corner) {
        keys.refuse("corner_radius", "is missing: a bull tool needs it");
    }
    if (tool.shape != ToolShape::kBull && corner) {
        keys.refuse("corner_radius", fmt::format("belongs to a bull tool, this one is {}", shape));
    }
    tool.corner_radius = tool.shape == ToolShape::kBall ? tool.radius : corner.value_or(0);
    if (tool.corner_radius > tool.radius) {
        keys.refuse("corner_radius", fmt::format("is {:g} mm, the tool's radius is only {:g} mm",
                                                 tool.corner_radius, tool.radius));
    }
    read_tip(keys, shape, millimetres, tool);
    keys.check_all_read();
    return tool;
}

}  // namespace cusp::import
