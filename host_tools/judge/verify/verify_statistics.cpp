// Writes the figures as JSON, one key for each.
#include "host_tools/judge/verify/verify_statistics.hpp"

#include <cmath>

#include "host_tools/base/json_text/json_text.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "nlohmann/json.hpp"

namespace cusp::verify {

namespace {

using Json = nlohmann::ordered_json;

double rounded(double value)
{
    constexpr double kMicro = 1e6;
    return std::round(value * kMicro) / kMicro;
}

void add_tools_to(Json& out, const std::vector<ToolFigures>& tools)
{
    for (const ToolFigures& t : tools) {
        out["tools"].push_back({{"number", t.tool.number},
                                {"shape", name_of(t.tool.shape)},
                                {"diameter_mm", rounded(2 * t.tool.radius)},
                                {"cut_length_mm", rounded(t.cut_length)},
                                {"cut_depth_max_mm", rounded(t.cut_depth_max)}});
    }
}

void add_engagement_to(Json& out, const EngagementFigures& f)
{
    out["engagement_max_deg"] = rounded(f.angle_max);
    if (f.line > 0) {
        out["engagement_max_at_mm"] = {rounded(f.place.x), rounded(f.place.y), rounded(f.place.z)};
        out["engagement_max_line"] = f.line;
    }
    if (f.limit) {
        out["max_engagement_deg"] = *f.limit;
        out["engagement_limited_max_deg"] = rounded(*f.limited_max);
        out["over_engagement_mm"] = rounded(*f.over_length);
    }
    out["air_mm"] = rounded(f.air_length);
    out["removed_mm3"] = rounded(f.removed_volume);
    out["removed_mm3_per_min"] = rounded(f.seconds > 0 ? 60 * f.removed_volume / f.seconds : 0);
}

void add_contacts_to(Json& out, const std::vector<ContactFigures>& contacts)
{
    for (const ContactFigures& f : contacts) {
        const std::string name = name_of_figure(f.part);
        out[name] = rounded(f.depth);
        if (f.depth > 0) {
            const std::string begin = name.substr(0, name.size() - std::string{"mm"}.size());
            out[begin + "at_mm"] = {rounded(f.tip.x), rounded(f.tip.y), rounded(f.tip.z)};
            out[begin + "line"] = f.line;
            out[begin + "tool"] = f.tool;
        }
    }
}

void add_between_sides_to(Json& out, const std::optional<FloorBetweenSides>& floor)
{
    if (floor) {
        out["between_sides_min_mm"] = rounded(floor->thickness);
        out["between_sides_at_mm"] = {rounded(floor->place.x), rounded(floor->place.y),
                                      rounded(floor->place.z)};
        out["between_sides_operation"] = floor->operation;
    }
}

// name  of the figure, which ends in _max_mm
void add_place_to(Json& out, const std::string& name, const std::optional<FaultPlace>& at)
{
    if (at) {
        out[name + "_at_mm"] = {rounded(at->place.x), rounded(at->place.y), rounded(at->place.z)};
        out[name + "_line"] = at->line;
        out[name + "_tool"] = at->tool;
    }
}

// Over 60 lines: one key after the other.
Json stats_of(const Verification& result)
{
    const VerifyFigures& f = result.figures;
    Json out{{"moves",
              {{"rapid", f.moves.rapids},
               {"line", f.moves.lines},
               {"arc", f.moves.arcs},
               {"nurbs", f.moves.nurbs}}},
             {"cut_length_mm", rounded(f.cut_length)},
             {"rapid_length_mm", rounded(f.rapid_length)},
             {"tool_positions", f.tool_positions},
             {"rapid_cut_max_mm", rounded(f.rapid_cut_max)},
             {"cut_depth_max_mm", rounded(f.cut_depth_max)},
             {"gouge_max_mm", rounded(f.gouge_max)}};
    add_place_to(out, "rapid_cut", f.rapid_cut_at);
    add_place_to(out, "gouge", f.gouge_at);
    add_place_to(out, "ball_gouge", f.ball_gouge_at);
    add_place_to(out, "wall_gouge", f.wall_gouge_at);
    add_tools_to(out, f.tools);
    const auto optional = [&](const char* name, std::optional<double> value) {
        if (value && std::isfinite(*value)) {
            out[name] = rounded(*value);
        }
    };
    optional("fixture_hit_max_mm", f.fixture_hit_max);
    add_contacts_to(out, f.contacts);
    optional("ball_gouge_max_mm", f.ball_gouge_max);
    optional("wall_gouge_max_mm", f.wall_gouge_max);
    optional("wall_left_max_mm", f.wall_left_max);
    if (f.engagement) {
        add_engagement_to(out, *f.engagement);
    }
    out["cells"] = f.cells;
    out["unreachable_share"] = rounded(f.unreachable_share);
    out["uncut_share"] = rounded(f.uncut_share);
    out["scallop_max_mm"] = rounded(f.scallop_max);
    out["scallop_p99_mm"] = rounded(f.scallop_p99);
    out["scallop_mean_mm"] = rounded(f.scallop_mean);
    out["left_volume_mm3"] = rounded(f.left_volume);
    if (f.scallop_bound) {
        out["scallop_bound_mm"] = *f.scallop_bound;
        out["uncovered_share"] = rounded(f.uncovered_share);
        if (!f.measured_tools.empty()) {
            out["measured_tools"] = f.measured_tools;
        }
        if (f.thickest_left) {
            const auto& [thickness, at] = *f.thickest_left;
            out["left_thickness_mm"] = rounded(thickness);
            out["left_thickness_at_mm"] = {rounded(at.x), rounded(at.y), rounded(at.z)};
        }
    }
    if (f.tabs_wanted > 0) {
        out["tabs_standing"] = f.tabs_standing;
        out["tabs_wanted"] = f.tabs_wanted;
    }
    if (f.wall_stock) {
        out["wall_stock_max_mm"] = rounded(f.wall_stock->thickness);
        add_place_to(out, "wall_stock", f.wall_stock->at);
    }
    if (f.level_left) {
        out["level_left_mm"] = rounded(f.level_left->height);
        out["level_left_at_mm"] = {rounded(f.level_left->place.x), rounded(f.level_left->place.y)};
        out["level_left_operation"] = f.level_left->operation;
    }
    add_between_sides_to(out, f.between_sides);
    out["broken"] = result.broken;
    return out;
}

std::string words_of_measured(const Verification& result)
{
    const std::vector<int>& tools = result.figures.measured_tools;
    return tools.empty() ? ""
                         : fmt::format(
                               "; the scallop of tool {} is proved where its end can touch, "
                               "measured elsewhere",
                               fmt::join(tools, ", "));
}

}  // namespace

std::string statistics_json(const Verification& result)
{
    return json_text::written(stats_of(result), 1) + "\n";
}

std::string verification_text(const Verification& result)
{
    std::string text;
    const Json stats = stats_of(result);
    for (const auto& [name, value] : stats.items()) {
        if (name != "broken") {
            text += fmt::format("{}: {}\n", name, json_text::written(value));
        }
    }
    for (const std::string& broken : result.broken) {
        text += fmt::format("broken: {}\n", broken);
    }
    return text +
           (result.broken.empty() ? "all bounds hold" + words_of_measured(result) + "\n" : "");
}

}  // namespace cusp::verify
