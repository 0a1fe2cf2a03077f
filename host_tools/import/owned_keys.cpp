// One list: a new key of one strategy gets a line here.
#include "host_tools/import/owned_keys.hpp"

#include <string_view>

#include "fmt/format.h"

namespace cusp::import {
namespace {

// Keys that only some strategies know; all others know every key that is not listed.
struct OwnedKey {
    const char* key;
    std::string_view strategies;
};
constexpr std::string_view kIsocurves{"adaptive_isocurve, complete_isocurves, parallel_planes"};
constexpr OwnedKey kOwnedKeys[]{
    {"iso_distance", "adaptive_isocurve, complete_isocurves"},
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

void refuse_keys_of_others(const toml::table& entry,
                           const JobTable& table,
                           const std::string& strategy)
{
    for (const OwnedKey& owned : kOwnedKeys) {
        // no strategy's name is a part of another's
        if (entry.contains(owned.key) &&
            owned.strategies.find(strategy) == std::string_view::npos) {
            table.refuse(owned.key,
                         fmt::format("is a key of {}, not of {}", owned.strategies, strategy));
        }
    }
}

}  // namespace cusp::import
