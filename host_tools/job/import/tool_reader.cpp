// Reads the shape first: it determines which lengths a tool has.
#include "host_tools/job/import/tool_reader.hpp"

#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/job/import/job_key_tables.hpp"

#include "fmt/format.h"

namespace cusp::import {

using toolpath::Coolant;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// The tool above the flutes.
void read_body(JobTable& keys, double millimetres, job::ToolFacts& facts)
{
    facts.shank_diameter = keys.length("shank_diameter", millimetres);
    if (facts.shank_diameter && !facts.flute_length) {
        keys.refuse("shank_diameter", "needs flute_length: the shank begins above the flutes");
    }
    if (const auto cylinders = keys.pairs("holder", "[diameter, length]")) {
        if (cylinders->empty()) {
            keys.refuse("holder", "is empty: a holder is at least one [diameter, length]");
        }
        if (!facts.length) {
            keys.refuse("holder", "needs length: how far the tool is out of the holder");
        }
        for (const auto& [diameter, length] : *cylinders) {
            facts.holder.push_back({diameter * millimetres, length * millimetres});
        }
    }
    const auto clearance = keys.length("holder_clearance", millimetres);
    if (clearance && !facts.shank_diameter && facts.holder.empty()) {
        keys.refuse("holder_clearance", "needs shank_diameter or holder");
    }
    facts.holder_clearance = keys.length_or_default("holder_clearance", millimetres);
}

// A depth of cut is judged by them when the job is planned.
job::ToolFacts read_facts(JobTable& keys, double millimetres)
{
    job::ToolFacts facts;
    facts.name = keys.text("name").value_or("");
    facts.flutes = keys.whole_number("flutes").value_or(0);
    facts.flute_length = keys.length("flute_length", millimetres);
    facts.length = keys.length("length", millimetres);
    if (facts.length && facts.flute_length && *facts.flute_length > *facts.length) {
        keys.refuse("flute_length", fmt::format("is {:g} mm, the tool is {:g} mm long",
                                                *facts.flute_length, *facts.length));
    }
    read_body(keys, millimetres, facts);
    return facts;
}

// The cone of a vee, a drill or a taper.
void read_tip(JobTable& keys, const std::string& shape, double millimetres, Tool& tool)
{
    constexpr double kTwistDrill = 118;
    const auto angle = keys.number("tip_angle");
    const auto flat = keys.number("tip_diameter");
    const bool tapers = tool.shape == ToolShape::kTaper;
    const auto taper = keys.number("taper_angle");
    if (tapers != taper.has_value()) {
        keys.refuse("taper_angle",
                    tapers ? "is missing: a taper needs the angle of its flank from the axis"
                           : fmt::format("belongs to a taper, this one is {}", shape));
    }
    if (tool.shape == ToolShape::kVee && !angle) {
        keys.refuse("tip_angle",
                    "is missing: a vee tool needs the angle between its flanks, such "
                    "as 60 or 90 degrees");
    }
    if ((!is_conical(tool) || tapers) && angle) {
        keys.refuse("tip_angle", fmt::format("belongs to a vee or a drill, this one is {}", shape));
    }
    if (tool.shape != ToolShape::kVee && !tapers && flat) {
        keys.refuse("tip_diameter",
                    fmt::format("belongs to a vee or a taper, this one is {}", shape));
    }
    if (tapers && !flat && tool.corner_radius <= 0) {
        keys.refuse("tip_diameter",
                    "is missing: a taper needs the diameter of its flat end, or "
                    "corner_radius, that of its ball");
    }
    if (tapers && flat && tool.corner_radius > 0) {
        keys.refuse("corner_radius", "is given beside tip_diameter: the end is a ball or flat");
    }
    if (is_conical(tool)) {
        tool.tip_angle = (tapers ? 2 * *taper : angle.value_or(kTwistDrill)) * kPi / 180;
        tool.tip_radius = flat.value_or(0) * millimetres / 2;
    }
    if (is_conical(tool) && tool.tip_radius >= tool.radius) {
        keys.refuse("tip_diameter", fmt::format("is {:g} mm, the tool's diameter is only {:g} mm",
                                                2 * tool.tip_radius, 2 * tool.radius));
    }
}

}  // namespace

void read_rates(JobTable& keys, double millimetres, Tool& tool)
{
    const auto feed = keys.number("feed");
    const auto plunge_feed = keys.number("plunge_feed");
    if (feed) {
        tool.rates.feed = *feed * millimetres;
        tool.rates.plunge_feed = tool.rates.feed / 4;
    }
    if (plunge_feed) {
        tool.rates.plunge_feed = *plunge_feed * millimetres;
    }
    if (const auto spindle = keys.number("spindle")) {
        tool.rates.spindle = spindle;
    }
    if (const auto coolant = keys.choice("coolant")) {
        tool.coolant = *coolant == "off"    ? Coolant::kOff
                       : *coolant == "mist" ? Coolant::kMist
                                            : Coolant::kFlood;
    }
}

ReadTool read_tool(const toml::table& table,
                   const std::string& file,
                   std::size_t index,
                   double millimetres)
{
    JobTable keys{table, file, fmt::format("tool {}", index), tool_table().keys};
    Tool tool;
    tool.number = keys.whole_number("number").value_or(static_cast<int>(index));
    const std::string shape = keys.choice("shape").value_or("");
    if (shape.empty()) {
        keys.refuse("shape",
                    "is missing: \"ball\", \"flat\", \"bull\", \"vee\", \"drill\" or \"taper\"");
    }
    tool.shape = shape == "ball"    ? ToolShape::kBall
                 : shape == "flat"  ? ToolShape::kFlat
                 : shape == "bull"  ? ToolShape::kBull
                 : shape == "vee"   ? ToolShape::kVee
                 : shape == "drill" ? ToolShape::kDrill
                                    : ToolShape::kTaper;
    tool.radius = keys.required_number("diameter") * millimetres / 2;
    const auto corner = keys.length("corner_radius", millimetres);
    if (tool.shape == ToolShape::kBull && !corner) {
        keys.refuse("corner_radius", "is missing: a bull tool needs it");
    }
    if (tool.shape != ToolShape::kBull && tool.shape != ToolShape::kTaper && corner) {
        keys.refuse("corner_radius",
                    fmt::format("belongs to a bull tool or a taper, this one is {}", shape));
    }
    tool.corner_radius = tool.shape == ToolShape::kBall ? tool.radius : corner.value_or(0);
    if (tool.corner_radius > tool.radius ||
        (tool.shape == ToolShape::kTaper && tool.corner_radius >= tool.radius)) {
        keys.refuse("corner_radius", fmt::format("is {:g} mm, the tool's radius is only {:g} mm",
                                                 tool.corner_radius, tool.radius));
    }
    read_tip(keys, shape, millimetres, tool);
    read_rates(keys, millimetres, tool);
    const job::ToolFacts facts = read_facts(keys, millimetres);
    keys.check_all_read();
    return {tool, facts};
}

}  // namespace cusp::import
