// A material: surface speed and chip by its maker's table, and the rates of a tool that follow from them.
//
//     const auto found = rates_in(material, {tool, flutes, {}}, mill);
//     found.rates.spindle;  // 4000 rpm; found.held_by: "mill.toml:5: spindle"
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/job/machine_tool.hpp"

namespace cusp::job {

// {diameter, value} in mm, by growing diameters.
using OfDiameter = std::vector<std::array<double, 2>>;

struct Material {
    std::string name;
    std::string source;      // who says so
    double surface_speed{};  // m/min, of mills
    OfDiameter chip;         // mm a tooth
    double drill_speed{};    // m/min
    OfDiameter drill_feed;   // mm a turn
};

// Between the entries of the table in proportion; below the first in proportion to the diameter, above the last as there.
double at_diameter(const OfDiameter& table, double diameter);

inline constexpr int kUsualFlutes = 2;  // where a tool has no number of them

struct RatedTool {
    const toolpath::Tool& tool;
    int flutes;                       // 0: kUsualFlutes
    std::optional<double> spindle{};  // rpm, where it is given
};

struct MaterialRates {
    toolpath::CuttingRates rates;
    double chip{};        // mm a tooth, of a drill a turn
    std::string held_by;  // place of the limit that lowered them; "": none
};

// Rates of a tool, with three digits. A cone counts with half its diameter. What the machine can't do lowers the
// spindle, so that the chip stays; where the spindle can't go lower, or is given, the feed alone.
//
// machine  its spindle and rates; those that it does not know are the default machine's
MaterialRates rates_in(const Material& material,
                       const RatedTool& rated,
                       const MachineTool& machine);

// "12000 rpm, 1200 mm/min: aluminium, 226 m/min, 0.05 mm a tooth (Harvey Tool); held back by mill.toml:5: spindle".
std::string words_of(const Material& material, const RatedTool& rated, const MaterialRates& found);

}  // namespace cusp::job
