// Compares the levels of each operation with the stock's.
#include "host_tools/job/level_warnings.hpp"

#include "fmt/format.h"

namespace cusp::job {

namespace {

constexpr double kSameLevel = 1e-6;  // mm

std::string warning_of(const Job& job, const Operation& operation)
{
    const double top = operation.prismatic->top;
    const double end = top - operation.prismatic->depth;
    const std::string name = fmt::format("operation {} ({})", operation.number, operation.strategy);
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

}  // namespace

std::vector<std::string> level_warnings(const Job& job)
{
    std::vector<std::string> warnings;
    int last = 0;  // several pockets of a drawing are one operation
    for (const Operation& operation : job.operations) {
        const bool follows_floor = operation.strategy == "engrave" && !operation.floor.empty();
        if (!operation.prismatic || follows_floor || operation.number == last) {
            continue;
        }
        last = operation.number;
        if (std::string text = warning_of(job, operation); !text.empty()) {
            warnings.push_back(std::move(text));
        }
    }
    return warnings;
}

}  // namespace cusp::job
