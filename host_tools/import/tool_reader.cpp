// Reads the shape first: it determines which lengths a tool has.
#include "host_tools/import/tool_reader.hpp"

#include <optional>

#include "host_tools/import/known_keys.hpp"

#include "fmt/format.h"

namespace cusp::import {

using toolpath::Tool;
using toolpath::ToolShape;

Tool read_tool(const toml::table& table,
               const std::string& file,
               std::size_t index,
               double millimetres)
{
    JobTable keys{table, file, fmt::format("tool {}", index), tool_keys()};
    Tool tool;
    tool.number = keys.whole_number("number", kToolNumber).value_or(static_cast<int>(index));
    const std::string shape = keys.one_of("shape", {"ball", "flat", "bull"}).value_or("");
    if (shape.empty()) {
        keys.refuse("shape", "is missing: \"ball\", \"flat\" or \"bull\"");
    }
    tool.shape = shape == "ball"   ? ToolShape::kBall
                 : shape == "flat" ? ToolShape::kFlat
                                   : ToolShape::kBull;
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
    keys.check_all_read();
    return tool;
}

}  // namespace cusp::import
