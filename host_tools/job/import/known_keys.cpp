// One list for each table; a new key is one line here.
#include "host_tools/job/import/known_keys.hpp"

#include <string_view>

#include "fmt/format.h"

namespace cusp::import {
namespace {

struct OperationKey {
    const char* key;
    std::string_view strategies;    // that know it; empty: all
    std::string_view without = {};  // that do not
};
constexpr std::string_view kIsocurves{"adaptive_isocurve, complete_isocurves, parallel_planes"};
constexpr std::string_view kRoughers{
    "hull_rough, contour_pocket, pocket, grid_pocket, adaptive_isocurve, complete_isocurves, "
    "parallel_planes"};
constexpr std::string_view kFeedsByLoad{
    "hull_rough, contour_pocket, pocket, grid_pocket, adaptive_isocurve, complete_isocurves, "
    "parallel_planes, profile, face"};
constexpr std::string_view kDepths{"pocket, profile, drill, face, engrave, v_carve"};
constexpr std::string_view kOpening{"pocket, drill, face, engrave, v_carve"};
constexpr std::string_view kPrismatic{"pocket, profile, drill, face, engrave, v_carve, chamfer"};
constexpr std::string_view kNoFloor{"pocket, profile, drill, face, v_carve, chamfer"};
constexpr std::string_view kAllButPocket{"profile, drill, face, engrave, v_carve, chamfer"};
constexpr std::string_view kNoScallop{"profile, drill, face, engrave, chamfer"};
constexpr std::string_view kLines{"drill, face, engrave, v_carve, chamfer"};
constexpr OperationKey kOperationKeys[]{
    {"strategy", ""},
    {"floor", "", kNoFloor},
    {"intersect", "", kPrismatic},
    {"boundary", ""},
    {"islands", "", kAllButPocket},
    {"tool", ""},
    {"output", "", "drill"},
    {"scallop", "", kNoScallop},
    {"floor_tolerance", ""},
    {"plan_tolerance", ""},
    {"join_gaps", "", "drill, engrave"},
    {"tolerance_side", "", kAllButPocket},
    {"direction_of_cut", "", "drill, engrave"},
    {"entry", "", kLines},
    {"traversal", "", "pocket, profile, drill, engrave, v_carve, chamfer"},
    {"allowance", "", kLines},
    {"max_depth", "", "drill, chamfer"},
    {"min_depth", "", kAllButPocket},
    {"layers", "", kAllButPocket},
    {"feed", ""},
    {"plunge_feed", ""},
    {"chip_load", kFeedsByLoad},
    {"feed_min", kFeedsByLoad},
    {"feed_max", kFeedsByLoad},
    {"spindle", ""},
    {"coolant", ""},
    {"iso_distance", "adaptive_isocurve, complete_isocurves"},
    {"iso_spacing", "adaptive_isocurve"},
    {"direction", kIsocurves},
    {"roughing", kIsocurves},
    {"step_over", "parallel_planes, pocket, face, v_carve"},
    {"grid", "grid_pocket"},
    {"zigzag", "grid_pocket"},
    {"arc_tolerance", "grid_pocket"},
    {"max_arc_radius", "grid_pocket"},
    {"max_roughness", "grid_pocket"},
    {"overlap", "hull_rough"},
    {"extra_subdivision", "hull_rough"},
    {"clearing", kRoughers},
    {"max_engagement", kRoughers},
    {"tools", "hull_rough, contour_pocket, pocket, adaptive_isocurve, complete_isocurves"},
    {"depth", kDepths},
    {"top", kPrismatic},
    {"side", "profile"},
    {"tabs", "profile"},
    {"lead_in", "profile"},
    {"lead_out", "profile"},
    {"diameter", "drill"},
    {"peck", "drill"},
    {"overhang", "face"},
    {"setup", ""},
    {"may_open", kOpening},
    {"after", ""},
    {"rest_tolerance", ""},
    {"width", "chamfer"}};

// True if the list, with commas between them, holds the word.
bool lists(std::string_view list, std::string_view word)
{
    while (!list.empty()) {
        const std::size_t comma = list.find(", ");
        if (list.substr(0, comma) == word) {
            return true;
        }
        list.remove_prefix(comma == std::string_view::npos ? list.size() : comma + 2);
    }
    return false;
}

}  // namespace

std::vector<std::string> strategy_names()
{
    return std::vector<std::string>{"contour_pocket",
                                    "adaptive_isocurve",
                                    "grid_pocket",
                                    "hull_rough",
                                    "complete_isocurves",
                                    "parallel_planes",
                                    "pocket",
                                    "profile",
                                    "drill",
                                    "face",
                                    "engrave",
                                    "v_carve",
                                    "chamfer"};
}

std::vector<std::string> job_keys()
{
    return {"units",   "tool", "library",   "cutting",       "stock", "placing",
            "fixture", "post", "operation", "group_by_tool", "setup"};
}

std::vector<std::string> library_keys() { return {"units", "tool"}; }

std::vector<std::string> tool_keys()
{
    return {"number",      "shape",          "diameter", "corner_radius",    "tip_angle",
            "taper_angle", "tip_diameter",   "name",     "flutes",           "flute_length",
            "length",      "shank_diameter", "holder",   "holder_clearance", "feed",
            "plunge_feed", "spindle",        "coolant"};
}

std::vector<std::string> cutting_keys() { return {"feed", "plunge_feed", "spindle"}; }

std::vector<std::string> stock_keys()
{
    return {"top",        "clearance",     "bottom",  "x",           "y",      "margin",
            "margin_top", "margin_bottom", "program", "least_floor", "outline"};
}

std::vector<std::string> placing_keys()
{
    return {"file", "scale", "up", "rotate", "origin", "move"};
}

std::vector<std::string> fixture_keys()
{
    return {"name", "x", "y", "centre", "diameter", "top", "margin", "setup"};
}
std::vector<std::string> setup_keys() { return {"name", "offset", "flip"}; }

std::vector<std::string> tabs_keys() { return {"count", "places", "width", "height", "shape"}; }

std::vector<std::string> operation_keys()
{
    std::vector<std::string> keys;
    for (const OperationKey& known : kOperationKeys) {
        keys.emplace_back(known.key);
    }
    return keys;
}

void refuse_keys_of_others(const toml::table& entry,
                           const JobTable& table,
                           const std::string& strategy)
{
    for (const OperationKey& known : kOperationKeys) {
        if (!entry.contains(known.key)) {
            continue;
        }
        if (lists(known.without, strategy)) {
            table.refuse(known.key, fmt::format("is no key of {}", strategy));
        }
        if (!known.strategies.empty() && !lists(known.strategies, strategy)) {
            table.refuse(known.key,
                         fmt::format("is a key of {}, not of {}", known.strategies, strategy));
        }
    }
}

}  // namespace cusp::import
