// Sums the length of feed moves above the stock or the part.
#include "host_tools/cli/stock_warning.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::cli {

using job::Job;
using job::Operation;
using toolpath::cut_length_above;

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
        most = std::max(most, kOverTolerance * operation.floor_tolerance);
    }
    return most;
}

AirShare share_above(const Job& job, const Plan& plan, double z)
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

}  // namespace

std::optional<std::string> stock_warning(const Job& job, const Plan& plan)
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

}  // namespace cusp::cli
