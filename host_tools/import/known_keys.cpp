// One list for each table; a new key is one line here.
#include "host_tools/import/known_keys.hpp"

#include <string_view>

#include "fmt/format.h"

namespace cusp::import {
namespace {

struct OperationKey {
    const char* key;
    std::string_view strategies;  // that accept it; empty: all
};
constexpr std::string_view kIsocurves{"adaptive_isocurve, complete_isocurves, parallel_planes"};
constexpr OperationKey kOperationKeys[]{
    {"strategy", ""},
    {"floor", ""},
    {"intersect", ""},
    {"boundary", ""},
    {"islands", ""},
    {"tool", ""},
    {"output", ""},
    {"scallop", ""},
    {"floor_tolerance", ""},
    {"plan_tolerance", ""},
    {"tolerance_side", ""},
    {"direction_of_cut", ""},
    {"entry", ""},
    {"traversal", ""},
    {"allowance", ""},
    {"max_depth", ""},
    {"min_depth", ""},
    {"layers", ""},
    {"feed", ""},
    {"plunge_feed", ""},
    {"spindle", ""},
    {"coolant", ""},
    {"iso_distance", "adaptive_isocurve, complete_isocurves"},
    {"iso_spacing", "adaptive_isocurve"},
    {"direction", kIsocurves},
    {"roughing", kIsocurves},
    {"step_over", "parallel_planes"},
    {"grid", "grid_pocket"},
    {"zigzag", "grid_pocket"},
    {"arc_tolerance", "grid_pocket"},
    {"max_arc_radius", "grid_pocket"},
    {"max_roughness", "grid_pocket"},
    {"overlap", "hull_rough"},
    {"extra_subdivision", "hull_rough"},
    {"clearing", "hull_rough"},
    {"tools", "hull_rough, contour_pocket, adaptive_isocurve, complete_isocurves"}};

}  // namespace

std::vector<std::string> job_keys()
{
    return {"units",   "tool",    "library", "cutting",   "stock",
            "placing", "fixture", "post",    "operation", "group_by_tool"};
}

std::vector<std::string> library_keys() { return {"units", "tool"}; }

std::vector<std::string> tool_keys()
{
    return {"number",       "shape",  "diameter", "corner_radius", "name",    "flutes",
            "flute_length", "length", "feed",     "plunge_feed",   "spindle", "coolant"};
}

std::vector<std::string> cutting_keys() { return {"feed", "plunge_feed", "spindle"}; }

std::vector<std::string> stock_keys()
{
    return {"top", "clearance", "bottom", "x", "y", "margin", "margin_top", "margin_bottom"};
}

std::vector<std::string> placing_keys()
{
    return {"file", "scale", "up", "rotate", "origin", "move"};
}

std::vector<std::string> fixture_keys()
{
    return {"name", "x", "y", "centre", "diameter", "top", "margin"};
}

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
        // no strategy's name is a substring of another's
        if (entry.contains(known.key) && !known.strategies.empty() &&
            known.strategies.find(strategy) == std::string_view::npos) {
            table.refuse(known.key,
                         fmt::format("is a key of {}, not of {}", known.strategies, strategy));
        }
    }
}

}  // namespace cusp::import
