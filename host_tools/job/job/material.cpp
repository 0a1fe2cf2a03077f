// Speed over circumference gives the spindle, chip times teeth the feed.
#include "host_tools/job/job/material.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "firmware/machine/settings.hpp"

#include "fmt/format.h"

namespace cusp::job {

using machine::Setting;
using toolpath::ToolShape;

namespace {

constexpr double kMillimetres = 1000;  // of a metre
constexpr double kPlungeOfFeed = 0.25;

bool is_drill(const RatedTool& rated) { return rated.tool.shape == ToolShape::kDrill; }

// The diameter that cuts; for a cone, that at the middle of its flank.
double cutting_diameter(const toolpath::Tool& tool)
{
    const bool cone = tool.shape == ToolShape::kVee || tool.shape == ToolShape::kTaper;
    return cone ? tool.radius : 2 * tool.radius;
}

double teeth_of(const RatedTool& rated)
{
    return is_drill(rated) ? 1 : rated.flutes > 0 ? rated.flutes : kUsualFlutes;
}

// Cut off after three digits, so that no limit is passed.
double in_three_digits(double value)
{
    if (value <= 0) {
        return 0;
    }
    constexpr double kThree = 1000;
    double step = 1;
    while (value / step >= kThree) {
        step *= 10;
    }
    while (value / step < kThree / 10) {
        step /= 10;
    }
    constexpr double kRounding = 1e-9;
    return std::floor(value / step + kRounding) * step;
}

MachineLimit limit_of(const std::optional<MachineLimit>& known, Setting setting, unsigned axis = 0)
{
    static const machine::Settings kDefault;
    return known
               ? *known
               : MachineLimit{
                     static_cast<double>(kDefault.value(setting, axis)),
                     fmt::format("${} of the default machine",
                                 machine::setting_entry(machine::index_of(setting, axis)).number)};
}

}  // namespace

double at_diameter(const OfDiameter& table, double diameter)
{
    if (diameter <= table.front()[0]) {
        return table.front()[1] * diameter / table.front()[0];
    }
    for (std::size_t k = 1; k < table.size(); ++k) {
        const auto& [above, most] = table[k];
        const auto& [below, least] = table[k - 1];
        if (diameter <= above) {
            return least + (most - least) * (diameter - below) / (above - below);
        }
    }
    return table.back()[1];
}

MaterialRates rates_in(const Material& material, const RatedTool& rated, const MachineTool& machine)
{
    const double across = cutting_diameter(rated.tool);
    const MachineLimit most_feed = limit_of(machine.most_feed(), Setting::kMaxRate);
    const MachineLimit most_plunge = limit_of(machine.most_plunge_feed(), Setting::kMaxRate, 2);
    const MachineLimit most_spindle = limit_of(machine.most_spindle, Setting::kSpindleMaximum);
    const double least_spindle = machine.least_spindle ? machine.least_spindle->value : 0;
    const double speed = is_drill(rated) ? material.drill_speed : material.surface_speed;
    MaterialRates found;
    found.chip = at_diameter(is_drill(rated) ? material.drill_feed : material.chip, across);
    const double of_turn = found.chip * teeth_of(rated);
    double spindle = rated.spindle.value_or(speed * kMillimetres / (kPi * across));
    const auto hold = [&](double least, const MachineLimit& limit) {
        if (spindle > least) {
            spindle = least;
            found.held_by = limit.place;
        }
    };
    // A drill's way is down, a mill goes down at a quarter of its feed.
    const double plunges = is_drill(rated) ? 1.0 : kPlungeOfFeed;
    if (!rated.spindle) {
        hold(most_spindle.value, most_spindle);
        hold(most_feed.value / of_turn, most_feed);
        hold(most_plunge.value / (plunges * of_turn), most_plunge);
        spindle = std::max(in_three_digits(spindle), least_spindle);
    }
    const auto held = [&](double rate, const MachineLimit& limit) {
        if (rate > limit.value) {
            found.held_by = limit.place;
        }
        return in_three_digits(std::min(rate, limit.value));
    };
    found.rates.spindle = spindle;
    found.rates.feed = held(spindle * of_turn, most_feed);
    found.rates.plunge_feed = held(plunges * spindle * of_turn, most_plunge);
    return found;
}

std::string words_of(const Material& material, const RatedTool& rated, const MaterialRates& found)
{
    const double speed = *found.rates.spindle * kPi * cutting_diameter(rated.tool) / kMillimetres;
    const std::string teeth =
        is_drill(rated) ? "a turn" : fmt::format("a tooth of {:g}", teeth_of(rated));
    return fmt::format("{:g} rpm, {:g} mm/min: {:.3g} m/min and {:.2g} mm {} in {} ({}){}",
                       *found.rates.spindle, found.rates.feed, speed, found.chip, teeth,
                       material.name, material.source,
                       found.held_by.empty() ? "" : "; held back by " + found.held_by);
}

}  // namespace cusp::job
