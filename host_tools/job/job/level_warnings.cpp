// Compares the levels of each operation with the stock's and with its tool.
#include "host_tools/job/job/level_warnings.hpp"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"

namespace cusp::job {

namespace {

constexpr double kSameLevel = 1e-6;  // mm

std::string warning_of(const Job& job, const Operation& operation)
{
    const double top = operation.prismatic->top;
    const double end = top - operation.prismatic->depth;
    const std::string name = fmt::format("operation {} ({})", operation.number, operation.name());
    if (end > job.stock_top - kSameLevel) {
        return fmt::format(
            "{} ends at z = {:.6g} mm, not below the stock's top, z = {:.6g} mm: it "
            "cuts air",
            name, end, job.stock_top);
    }
    if (!job.stock_bottom) {
        return {};
    }
    if (top < *job.stock_bottom + kSameLevel) {
        return fmt::format(
            "{} begins at z = {:.6g} mm, not above the stock's bottom, z = {:.6g} "
            "mm: it cuts what is below",
            name, top, *job.stock_bottom);
    }
    // drills and outlines go through by less
    const double below = *job.stock_bottom - end;
    if (below > 2 * operation.tool.radius) {
        return fmt::format(
            "{} goes {:.6g} mm below the stock's bottom, z = {:.6g} mm: it cuts what "
            "is below",
            name, below, *job.stock_bottom);
    }
    return {};
}

// mm: depth of the deepest level, where the first cut of a level is a slot as wide as the tool; 0 where it is not.
double depth_of_slot(const Operation& operation)
{
    const bool in_slots = operation.cuts(Region::kOutline) ||
                          operation.cuts(Region::kLevelPocket) || operation.cuts(Region::kTop) ||
                          operation.cuts(Region::kGrooves);
    if (!in_slots || operation.passes.max_engagement || !operation.levels.layers.empty()) {
        return 0;
    }
    const double depth = operation.prismatic->depth;
    const double most = operation.levels.max_depth.value_or(depth);
    return depth / std::ceil(depth / most - kSameLevel);
}

// True if what an earlier operation or program left is all that there is to cut: how deep that is
// is not known here.
bool is_cut_before(const Job& job, const Operation& operation)
{
    const auto cuts_it = [&](const Operation& before) {
        return before.number < operation.number && before.prismatic &&
               !before.cuts(Region::kHoles) && !before.cuts(Region::kEdges) &&
               before.prismatic->file == operation.prismatic->file &&
               before.prismatic->top - before.prismatic->depth <=
                   operation.prismatic->top - operation.prismatic->depth + kSameLevel;
    };
    return !job.stock_programs.empty() || !operation.rest.after.empty() ||
           std::any_of(job.operations.begin(), job.operations.end(), cuts_it);
}

// A slot deeper than the mill is wide: makers of mills give that as the limit of full slots (Widia, Solid End Milling).
std::string depth_warning(const Job& job, const Operation& operation)
{
    const double across = 2 * operation.tool.radius;
    const double depth = operation.prismatic->depth;
    const double level = depth_of_slot(operation);
    if (level <= across + kSameLevel || is_cut_before(job, operation)) {
        return {};
    }
    const double levels = std::ceil(depth / across - kSameLevel);
    const bool at_once = level > depth - kSameLevel;
    return fmt::format(
        "operation {} ({}): tool {} of {:.6g} mm cuts {:.6g} mm deep in one level, {:.3g} times "
        "its diameter{}: a max_depth of {:.6g} mm would make {:g} levels of {:.4g} mm",
        operation.number, operation.name(), operation.tool.number, across, level, level / across,
        at_once ? "" : ", the limit of full slots", across, levels, depth / levels);
}

}  // namespace

std::vector<std::string> level_warnings(const Job& job)
{
    std::vector<std::string> warnings;
    int last = 0;  // several pockets of a drawing are one operation
    for (const Operation& operation : job.operations) {
        const bool follows_floor =
            operation.cuts(Region::kGrooves) && !operation.part.floor.empty();
        if (!operation.prismatic || follows_floor || operation.number == last) {
            continue;
        }
        last = operation.number;
        for (std::string text : {warning_of(job, operation), depth_warning(job, operation)}) {
            if (!text.empty()) {
                warnings.push_back(std::move(text));
            }
        }
    }
    return warnings;
}

}  // namespace cusp::job
