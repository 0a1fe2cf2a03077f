// Options are refused, choices are lowered.
#include "host_tools/job/import/one_line_rates.hpp"

#include <algorithm>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/machine_reader.hpp"
#include "host_tools/job/import/material_reader.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::MachineLimit;
using job::MachineTool;
using toolpath::ToolShape;

namespace {

// A rate, its option, and the machine's limits in the unit of the call.
class BoundRate {
public:
    BoundRate(const char* option, const char* unit, double scale)
        : option_{option}, unit_{unit}, scale_{scale}
    {
    }

    double bounded(std::optional<double> asked,
                   double chosen,
                   const std::optional<MachineLimit>& least,
                   const std::optional<MachineLimit>& most) const
    {
        if (asked && most && *asked > most->value / scale_) {
            refuse(*asked, "above", *most);
        }
        if (asked && least && *asked > 0 && *asked < least->value / scale_) {
            refuse(*asked, "below", *least);
        }
        if (asked) {
            return *asked;
        }
        const double low = least ? std::max(chosen, least->value / scale_) : chosen;
        return most ? std::min(low, most->value / scale_) : low;
    }

private:
    [[noreturn]] void refuse(double asked, const char* side, const MachineLimit& limit) const
    {
        throw InputError(fmt::format("{}: is {:.6g} {}, {} the {:.6g} {} of {}", option_, asked,
                                     unit_, side, limit.value / scale_, unit_, limit.place));
    }

    const char* option_;
    const char* unit_;
    double scale_;
};

}  // namespace

namespace {

toolpath::Tool tool_of(const NamedTool& named, double scale)
{
    toolpath::Tool tool;
    tool.radius = named.diameter * scale / 2;
    tool.shape = named.shape == name_of(ToolShape::kDrill) ? ToolShape::kDrill
                 : named.shape == name_of(ToolShape::kVee) ? ToolShape::kVee
                                                           : ToolShape::kFlat;
    return tool;
}

// The rates of the material in place of the usual ones; options stay.
void rate_by_material(const OneLineRequest& request,
                      const MachineTool& machine,
                      double scale,
                      OneLineChoice& choice)
{
    const job::Material material = read_material(request.material, "");
    for (std::size_t k = 0; k < choice.tools.size(); ++k) {
        const toolpath::Tool tool = tool_of(choice.tools[k], scale);
        const job::RatedTool rated{tool, 0, request.spindle};
        const job::MaterialRates found = rates_in(material, rated, machine);
        choice.spindles[k] = *found.rates.spindle;
        if (!request.feed) {
            choice.feeds[k] = three_digits(found.rates.feed / scale);
            choice.plunge_feeds[k] =
                request.plunge_feed.value_or(three_digits(found.rates.plunge_feed / scale));
        }
        choice.rated.push_back(fmt::format("{}: {}", words_of(choice.tools[k], request.inch),
                                           words_of(material, rated, found)));
    }
}

}  // namespace

void put_rates(const OneLineRequest& request, OneLineChoice& choice)
{
    const MachineTool machine =
        request.machine.empty() ? MachineTool{} : read_machine(request.machine, "");
    const double scale = request.inch ? kMillimetresPerInch : 1.0;
    const char* const rate = request.inch ? "inch/min" : "mm/min";
    if (!request.material.empty()) {
        rate_by_material(request, machine, scale, choice);
    }
    for (std::size_t k = 0; k < choice.feeds.size(); ++k) {
        choice.feeds[k] = BoundRate{"--feed", rate, scale}.bounded(request.feed, choice.feeds[k],
                                                                   {}, machine.most_feed());
        choice.plunge_feeds[k] = BoundRate{"--plunge-feed", rate, scale}.bounded(
            request.plunge_feed, choice.plunge_feeds[k], {}, machine.most_plunge_feed());
        choice.spindles[k] = BoundRate{"--spindle", "rpm", 1.0}.bounded(
            request.spindle, choice.spindles[k], machine.least_spindle, machine.most_spindle);
    }
}

}  // namespace cusp::import
