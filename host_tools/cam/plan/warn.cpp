// Sentences on what may not be meant.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/level_warnings.hpp"
#include "host_tools/job/job/overlap_warnings.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::Operation;
using job::ToolFacts;
using toolpath::cut_length_above;
using toolpath::PlannedOperation;
using toolpath::ToolMove;

namespace {

constexpr double kSameHeight = 1e-3;       // mm
constexpr double kWorthTelling = 1.0 / 3;  // of the feed moves

struct AirShare {
    double metres;
    double of_metres;

    double share() const { return metres / of_metres; }
    std::string text() const
    {
        return fmt::format("{:.3g} of {:.3g} m of feed moves ({:.0f} %)", metres, of_metres,
                           100 * share());
    }
};

// Passes on the part's top are above it by their tolerance.
double pass_height(const Job& job)
{
    constexpr double kOverTolerance = 2;
    double most = kSameHeight;
    for (const Operation& operation : job.operations) {
        most = std::max(most, kOverTolerance * operation.tolerance.floor);
    }
    return most;
}

AirShare share_above(const Job& job, const PlannedProgram& plan, double z)
{
    constexpr double kMillimetres = 1000;  // of a metre
    AirShare sum{0, 0};
    Vec3d at{0, 0, job.stock_top + job.clearance};
    for (std::size_t i = 0; i < plan.operations.size(); ++i) {
        sum.metres += cut_length_above(plan.operations[i].path, at, z) / kMillimetres;
        sum.of_metres += plan.measures[i].cut_length_mm / kMillimetres;
        at = plan.measures[i].end;
    }
    return sum;
}

// The warning where the stock's top differs from the part's, with the length of the path in air. No value where the
// tops are equal, and where the stock is higher but less than a third of the feed moves is above the part.
std::optional<std::string> stock_warning(const Job& job, const PlannedProgram& plan)
{
    if (!job.part_top) {
        return std::nullopt;
    }
    const double over = job.stock_top - *job.part_top;
    const auto tops = [&](const char* below_or_above) {
        return fmt::format(
            "stock: its top, z = {:.6g} mm, is {:.6g} mm {} the part's, z = {:.6g} mm",
            job.stock_top, std::abs(over), below_or_above, *job.part_top);
    };
    if (over < -kSameHeight) {
        return fmt::format(
            "{}: {} are above the stock, in air; without top in [stock] it is the part's",
            tops("below"), share_above(job, plan, job.stock_top).text());
    }
    if (const double passes = pass_height(job); over > passes) {
        const AirShare air = share_above(job, plan, *job.part_top + passes);
        if (air.share() >= kWorthTelling) {
            return fmt::format(
                "{}: {} are above the part, in air where the stock is lower; without top in "
                "[stock] it is the part's",
                tops("above"), air.text());
        }
    }
    return std::nullopt;
}

// Such a shank is judged by its contacts.
bool has_wide_shank(const Job& job, int number)
{
    const ToolFacts& facts = job.tool_facts.at(number);
    return std::any_of(job.tools.begin(), job.tools.end(), [&](const toolpath::Tool& tool) {
        return tool.number == number && facts.shank_diameter &&
               *facts.shank_diameter / 2 > tool.radius;
    });
}

// A warning for each tool that goes deeper below the stock's top than it, or its flutes, are long, where
// the job does not give the holder or a shank that is wider than the cutter.
std::vector<std::string> reach_warnings(const Job& job, const PlannedProgram& plan)
{
    std::map<int, double> lowest;  // z of the tip, by the number of the tool
    for (const PlannedOperation& operation : plan.operations) {
        double& z = lowest.try_emplace(operation.path.tool.number, job.stock_top).first->second;
        for (const ToolMove& move : operation.path.moves) {
            z = std::min(z, end_of(move).z);
        }
    }
    std::vector<std::string> warnings;
    for (const auto& [number, z] : lowest) {
        const auto found = job.tool_facts.find(number);
        if (found == job.tool_facts.end()) {
            continue;
        }
        const ToolFacts& facts = found->second;
        const double depth = job.stock_top - z;
        const bool too_long = facts.holder.empty() && facts.length && depth > *facts.length;
        if (too_long ||
            (!has_wide_shank(job, number) && facts.flute_length && depth > *facts.flute_length)) {
            warnings.push_back(
                fmt::format("tool {}{} goes {:.3g} mm below the stock's top, {} {:.3g} mm long: {}",
                            number, facts.name.empty() ? "" : " (" + facts.name + ")", depth,
                            too_long ? "it is" : "its flutes are",
                            too_long ? *facts.length : *facts.flute_length,
                            too_long ? "its holder may touch" : "its shank may rub"));
        }
    }
    return warnings;
}

// A warning for each tool that stands far out of its holder. What bends, bends with the cube of its length and the fourth
// power of its diameter: flutes and shank together count as a rod as wide as the tool.
std::vector<std::string> stick_out_warnings(const Job& job, const PlannedProgram& plan)
{
    constexpr double kSlender = 8;  // diameters: beyond, makers sell mills as long reach
    const auto cube = [](double length) {
        return length * length * length;
    };
    std::map<int, std::string> warnings;  // by the number of the tool
    for (const PlannedOperation& operation : plan.operations) {
        const toolpath::Tool& tool = operation.path.tool;
        const auto found = job.tool_facts.find(tool.number);
        if (found == job.tool_facts.end() || !found->second.length) {
            continue;
        }
        const ToolFacts& facts = found->second;
        const double across = 2 * tool.radius;
        const double length = *facts.length;
        const double flutes = facts.flute_length.value_or(length);
        const double thinner = across / facts.shank_diameter.value_or(across);
        const double bends =
            (cube(flutes) + (cube(length) - cube(flutes)) * cube(thinner) * thinner) /
            cube(kSlender * across);
        if (bends > 1) {
            warnings[tool.number] = fmt::format(
                "tool {}{} stands {:.3g} mm out of its holder, {:.2g} diameters: it bends {:.2g} "
                "times as far as one of {:g} "
                "diameters: use a shorter or a wider one, or lower its feed",
                tool.number, facts.name.empty() ? "" : " (" + facts.name + ")", length,
                length / across, bends, kSlender);
        }
    }
    std::vector<std::string> texts;
    for (const auto& [number, text] : warnings) {
        texts.push_back(text);
    }
    return texts;
}

bool cuts_walls(const Operation& operation)
{
    return operation.cuts(job::Region::kLevelPocket) ||
           (operation.cuts(job::Region::kOutline) &&
            operation.prismatic->side != job::ProfileSide::kOn);
}

// A warning for each operation whose walls end within the round of its tool: there the tool is narrower than the
// radius that it keeps from the wall.
std::vector<std::string> round_end_warnings(const Job& job)
{
    std::map<int, std::string> warnings;  // by the number of the operation
    for (const Operation& operation : job.operations) {
        const toolpath::Tool& tool = operation.tool;
        if (!operation.prismatic || !cuts_walls(operation)) {
            continue;
        }
        const double depth = operation.prismatic->depth;
        const double left = tool.radius - radius_at_height(tool, depth);
        // The path of a pocket keeps half of the tolerance from its walls.
        const double most =
            operation.tolerance.plan * (operation.cuts(job::Region::kLevelPocket) ? 0.5 : 1.0);
        if (depth < end_height(tool) && left > most) {
            warnings[operation.number] = fmt::format(
                "operation {}, {}: {:.4g} mm are left on the upper edge of its walls "
                "(plan_tolerance is {:g} mm): it is {:g} mm deep, but the round end of tool {} is "
                "{:g} mm high; cut deeper, "
                "or use a flat end",
                operation.number, operation.name(), left, operation.tolerance.plan, depth,
                tool.number, end_height(tool));
        }
    }
    std::vector<std::string> texts;
    for (const auto& [number, text] : warnings) {
        texts.push_back(text);
    }
    return texts;
}

}  // namespace

void warn(Planning& planning)
{
    const Job& job = planning.job;
    std::vector<std::string>& warnings = planning.program.warnings;
    if (const auto warning = stock_warning(job, planning.program)) {
        warnings.push_back(*warning);
    }
    for (const std::vector<std::string>& more :
         {job::overlap_warnings(job), job::level_warnings(job),
          reach_warnings(job, planning.program), stick_out_warnings(job, planning.program),
          round_end_warnings(job)}) {
        warnings.insert(warnings.end(), more.begin(), more.end());
    }
}

}  // namespace cusp::plan
