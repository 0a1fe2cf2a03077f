// Equal levels between the top of the stock and the lowest point; the rest of max_depth is for
// scallops.
#include "host_tools/cam/adaptive_isocurve/rough_depths.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using job::Job;
using job::Operation;
using toolpath::Tool;

namespace {

constexpr double kWritten = 2e-3;  // mm: rounding of two levels in the program
constexpr double kMaxRings = 1e4;
constexpr double kSame = 1e-9;           // mm
constexpr double kScallopOfDepth = 0.2;  // of the depth: scallops of round corners
constexpr double kLeastScallop = 0.02;   // of the depth: scallops where levels leave no more
constexpr double kRestOfScallop = 0.25;  // of the scallop: rest height of several cutters

[[noreturn]] void refuse(const Job& job, const std::string& what)
{
    throw InputError(fmt::format("{}: roughing: {}", job.file, what));
}

double roundest(const std::vector<Tool>& tools)
{
    double corner = 0;
    for (const Tool& tool : tools) {
        corner = std::max(corner, tool.corner_radius);
    }
    return corner;
}

std::vector<double> given_levels(const Job& job,
                                 const Operation& operation,
                                 double top,
                                 double bottom)
{
    std::vector<double> out;
    double above = top;
    for (const double depth : operation.levels.layers) {
        const double z = job.stock_top - depth;
        if (z < bottom - kSame) {
            refuse(job, fmt::format("layers: depth {:g} mm is below the bottom at z = {:g} mm (the "
                                    "lowest place of the part, or of the stock, and the allowance)",
                                    depth, bottom));
        }
        if (operation.levels.max_depth && above - z > *operation.levels.max_depth + kSame) {
            refuse(job, fmt::format("layers: the one at depth {:g} mm is {:g} mm deep, more than "
                                    "max_depth, {:g} mm",
                                    depth, above - z, *operation.levels.max_depth));
        }
        if (operation.levels.min_depth && above - z < *operation.levels.min_depth - kSame) {
            refuse(job, fmt::format("layers: the one at depth {:g} mm is {:g} mm deep, less than "
                                    "min_depth, {:g} mm",
                                    depth, above - z, *operation.levels.min_depth));
        }
        out.push_back(z);
        above = z;
    }
    return out;
}

}  // namespace

PassSpacing pass_spacing(const Tool& tool, double scallop_height)
{
    const double corner = tool.corner_radius;
    const double low = std::min(scallop_height, 0.15 * corner);
    const double round = 2.0 * std::sqrt(low * (2.0 * corner - low));
    const double flat = 1.2 * (tool.radius - corner);
    return flat > round ? PassSpacing{flat, 0.0} : PassSpacing{round, low};
}

RoughDepths rough_depths(const Job& job,
                         const Operation& operation,
                         const std::vector<Tool>& tools,
                         double top,
                         double bottom)
{
    const double depth = operation.levels.max_depth.value_or(least_radius(tools));
    if (depth <= kWritten) {
        refuse(job, fmt::format("max_depth is {:g} mm, not above {:g} mm", depth, kWritten));
    }
    const double deep = top - bottom;
    if (operation.levels.layers.empty() && deep < kWritten / 2) {
        return {};
    }
    const double rests = tools.size() > 1 ? 1.0 + kRestOfScallop : 1.0;
    const double wanted = rests * std::min(kScallopOfDepth * depth, 0.15 * roundest(tools));
    const double least = std::min(wanted, kLeastScallop * depth);
    RoughDepths out;
    out.heights = given_levels(job, operation, top, bottom);
    double thickest = 0;
    if (out.heights.empty()) {
        const auto levels = [&](double scallops) {
            const double step = std::max(0.5 * depth, depth - scallops - kWritten);
            return std::max(1.0, std::ceil(deep / step - kSame));
        };
        double count = levels(wanted);
        if (deep / count < operation.levels.min_depth.value_or(0)) {
            count =
                std::max(levels(least),
                         std::min(count, std::floor(deep / *operation.levels.min_depth + kSame)));
        }
        if (count > kMaxRings) {
            refuse(job, fmt::format("max_depth makes {:.0f} levels of a stock {:g} mm high, more "
                                    "than {:g}",
                                    count, deep, kMaxRings));
        }
        for (double k = 1; k <= count; ++k) {
            out.heights.push_back(top - deep * k / count);
        }
    }
    out.thinnest = kInfinite;
    double above = top;
    for (const double z : out.heights) {
        thickest = std::max(thickest, above - z);
        out.thinnest = std::min(out.thinnest, above - z);
        above = z;
    }
    // Depths that the job gives limit the scallops as well.
    const double left = operation.levels.max_depth || operation.levels.layers.empty()
                            ? depth - kWritten - thickest
                            : wanted;
    const double scallops = std::max(least, std::min(wanted, left));
    out.scallop_height = scallops / rests;
    out.rest_height = scallops - out.scallop_height;
    return out;
}

}  // namespace cusp::adaptive_isocurve
