// The pitch depends on the least tool, and on the memory that a grid may take.
#include "host_tools/judge/verify/stock_grid.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/job/job/stock_sides.hpp"
#include "host_tools/judge/verify/cut_regions.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::least_radius;

namespace {

constexpr double kDefaultPitch = 0.173;  // no simple ratio to common stepovers
constexpr double kDefaultSpacing = 0.1;

}  // namespace

PartBox stock_box(const Job& job, PartBox parts)
{
    PartBox box = parts;
    if (const auto plan = prismatic_box(job)) {
        box.x_low = std::min(box.x_low, plan->low.x);
        box.x_high = std::max(box.x_high, plan->high.x);
        box.y_low = std::min(box.y_low, plan->low.y);
        box.y_high = std::max(box.y_high, plan->high.y);
    }
    if (job.stock_x) {
        box.x_low = std::min(box.x_low, (*job.stock_x)[0]);
        box.x_high = std::max(box.x_high, (*job.stock_x)[1]);
    }
    if (job.stock_y) {
        box.y_low = std::min(box.y_low, (*job.stock_y)[0]);
        box.y_high = std::max(box.y_high, (*job.stock_y)[1]);
    }
    // Beside the stock there is air, also where the drawing of a pocket continues.
    if (!job.stock_outline.empty() ||
        std::any_of(job.operations.begin(), job.operations.end(),
                    [&](const job::Operation& o) { return is_open_pocket(job, o); })) {
        const job::StockSides sides = stock_sides(job);
        box.x_low = std::max(box.x_low, sides.x_low);
        box.x_high = std::min(box.x_high, sides.x_high);
        box.y_low = std::max(box.y_low, sides.y_low);
        box.y_high = std::min(box.y_high, sides.y_high);
    }
    return box;
}

HeightGrid stock_grid(const Job& job, PartBox parts, std::optional<double> pitch, double most)
{
    const PartBox box = stock_box(job, parts);
    const double width = box.x_high - box.x_low;
    const double height = box.y_high - box.y_low;
    constexpr double kPitchesPerRadius = 16;
    const double wanted =
        pitch.value_or(std::min(kDefaultPitch, least_radius(job.tools) / kPitchesPerRadius));
    const double used = std::max(wanted, std::sqrt(width * height / most));
    const auto count = [&](double length) {
        return std::max<std::size_t>(1, static_cast<std::size_t>(length / used));
    };
    return {box.x_low + used / 2, box.y_low + used / 2, used, count(width), count(height), true};
}

double position_spacing(const Job& job)
{
    constexpr double kSpacingsPerRadius = 20;
    return std::min(kDefaultSpacing, least_radius(job.tools) / kSpacingsPerRadius);
}

}  // namespace cusp::verify
