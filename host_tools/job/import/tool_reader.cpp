// Reads the shape first: it determines which lengths a tool has.
#include "host_tools/job/import/tool_reader.hpp"

#include <optional>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/job/import/job_key_tables.hpp"

#include "fmt/format.h"

namespace cusp::import {

using toolpath::Coolant;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// The tool above the flutes.
void read_body(JobTable& keys, job::ToolFacts& facts)
{
    facts.shank_diameter = keys.number("shank_diameter");
    if (auto cylinders = keys.pairs("holder")) {
        if (cylinders->empty()) {
            keys.refuse("holder", "is empty: a holder is at least one [diameter, length]");
        }
        facts.holder = std::move(*cylinders);
    }
    facts.holder_clearance = keys.number_or_default("holder_clearance");
}

// A depth of cut is judged by them when the job is planned.
job::ToolFacts read_facts(JobTable& keys)
{
    job::ToolFacts facts;
    facts.name = keys.text("name").value_or("");
    facts.flutes = keys.whole_number("flutes").value_or(0);
    facts.flute_length = keys.number("flute_length");
    facts.length = keys.number("length");
    if (facts.length && facts.flute_length && *facts.flute_length > *facts.length) {
        keys.refuse("flute_length", fmt::format("is {:g} mm, the tool is {:g} mm long",
                                                *facts.flute_length, *facts.length));
    }
    read_body(keys, facts);
    return facts;
}

// The cone of a vee, a drill or a taper.
void read_tip(JobTable& keys, const std::string& shape, Tool& tool)
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
    if (is_conical(tool)) {
        tool.tip_angle = (tapers ? 2 * *taper : angle.value_or(kTwistDrill)) * kPi / 180;
        tool.tip_radius = flat.value_or(0) / 2;
    }
    if (is_conical(tool) && tool.tip_radius >= tool.radius) {
        keys.refuse("tip_diameter", fmt::format("is {:g} mm, the tool's diameter is only {:g} mm",
                                                2 * tool.tip_radius, 2 * tool.radius));
    }
}

}  // namespace

void read_rates(JobTable& keys, Tool& tool)
{
    const auto feed = keys.number("feed");
    const auto plunge_feed = keys.number("plunge_feed");
    if (feed) {
        tool.rates.feed = *feed;
        tool.rates.plunge_feed = tool.rates.feed / 4;
    }
    if (plunge_feed) {
        tool.rates.plunge_feed = *plunge_feed;
    }
    if (const auto spindle = keys.number("spindle")) {
        tool.rates.spindle = spindle;
    }
    if (const auto coolant =
            keys.chosen("coolant", {Coolant::kOff, Coolant::kMist, Coolant::kFlood})) {
        tool.coolant = *coolant;
    }
}

ReadTool read_tool(JobTable& keys, std::size_t index)
{
    Tool tool;
    tool.number = keys.whole_number("number").value_or(static_cast<int>(index));
    const std::string shape = keys.choice("shape").value();
    tool.shape = *keys.chosen("shape", {ToolShape::kBall, ToolShape::kFlat, ToolShape::kBull,
                                        ToolShape::kVee, ToolShape::kDrill, ToolShape::kTaper});
    tool.radius = keys.number("diameter").value() / 2;
    const auto corner = keys.number("corner_radius");
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
    read_tip(keys, shape, tool);
    read_rates(keys, tool);
    const job::ToolFacts facts = read_facts(keys);
    keys.check_all_read();
    return {tool, facts};
}

}  // namespace cusp::import
