// Two maps of heights on one grid: the stock from above, and what the other side's programs cut from
// below, without the moves that went through.
#include "host_tools/judge/verify/between_sides.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Job;
using job::Operation;

namespace {

constexpr double kCut = 1e-3;  // mm: less is rounding

// Profiles part and chamfers break edges: neither leaves a floor. A cut through the bottom may
// open.
bool is_judged(const Job& job, const Operation& operation)
{
    if (!operation.prismatic || operation.may_open || operation.cuts(job::Region::kOutline) ||
        operation.cuts(job::Region::kEdges)) {
        return false;
    }
    const job::Prismatic& cut = *operation.prismatic;
    return cut.top - cut.depth > *job.stock_bottom + kCut;
}

bool turns_over(const job::SetupProgram& program) { return program.turn.turns_over(); }

// The stock as the other side's programs see it: turned in plan, with heights of their own.
class OtherSide {
public:
    OtherSide(const Job& job, const HeightGrid& grid, double spacing)
        : job_{job}, spacing_{spacing}, blind_{grid, job.stock_top}, through_{grid, job.stock_top}
    {
        for (const job::SetupProgram& program : job.turned_programs) {
            if (turns_over(program)) {
                for (const ToolPositions& run : program_positions(job, program.file, spacing)) {
                    add(program.turn, run);
                }
            }
        }
    }

    // z of its cut, as this side sees it; nothing where it has not cut or has gone through.
    std::optional<double> underside(std::size_t k) const
    {
        const double height = blind_.heights()[k];
        if (height > job_.stock_top - kCut || through_.heights()[k] < *job_.stock_bottom) {
            return std::nullopt;
        }
        return job_.stock_top + *job_.stock_bottom - height;
    }

private:
    // Runs of positions on either side of the bottom.
    void add(const job::SetupFlip& turn, const ToolPositions& run)
    {
        ToolPositions part{run.tool, {}, {}};
        bool goes_through = false;
        for (const Vec3d tip : run.tips) {
            const bool here = tip.z <= *job_.stock_bottom + kCut;
            if (here != goes_through) {
                cut(part, goes_through);
                goes_through = here;
            }
            const Vec3d turned = turn.of(tip);
            part.tips.push_back({turned.x, turned.y, tip.z});
        }
        cut(part, goes_through);
    }

    void cut(ToolPositions& part, bool goes_through)
    {
        part.rapid.assign(part.tips.size(), false);
        part.lines.assign(part.tips.size(), 0);
        const auto quiet = [](double) {
        };
        if (goes_through) {
            ToolPositions whole = part;
            whole.tool = {};
            whole.tool.shape = toolpath::ToolShape::kFlat;
            whole.tool.radius = part.tool.radius;
            for (Vec3d& tip : whole.tips) {
                tip.z = *job_.stock_bottom - 1;
            }
            through_.cut(whole, spacing_, quiet);
        } else if (!part.tips.empty()) {
            blind_.cut(part, spacing_, quiet);
        }
        part.tips.clear();
    }

    const Job& job_;
    double spacing_;
    MachinedStock blind_;
    MachinedStock through_;
};

bool can_be_judged(const Job& job)
{
    return std::any_of(job.turned_programs.begin(), job.turned_programs.end(), turns_over) &&
           std::any_of(job.operations.begin(), job.operations.end(),
                       [&](const Operation& operation) { return is_judged(job, operation); });
}

}  // namespace

std::optional<FloorBetweenSides> floor_between_sides(const Job& job,
                                                     const HeightGrid& grid,
                                                     const std::vector<double>& heights,
                                                     double spacing)
{
    if (!can_be_judged(job)) {
        return std::nullopt;
    }
    const OtherSide other{job, grid, spacing};
    std::vector<CutRegion> regions;
    for (const Operation& operation : job.operations) {
        if (is_judged(job, operation)) {
            regions.emplace_back(operation, grid);
        }
    }
    std::optional<FloorBetweenSides> thinnest;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const auto underside = other.underside(k);
        if (!underside || !(heights[k] < job.stock_top - kCut) ||
            heights[k] <= *job.stock_bottom + kCut) {
            continue;
        }
        const double x = grid.x(k / grid.ny, k % grid.ny);
        const double y = grid.y(k / grid.ny, k % grid.ny);
        for (const CutRegion& region : regions) {
            const RegionAt at = region.at(x, y, k);
            // deeper cuts here are those of others
            const double floor = std::max(heights[k], at.floor);
            if (at.inside > 0 && (!thinnest || floor - *underside < thinnest->thickness)) {
                thinnest = {floor - *underside,
                            {x, y, floor},
                            region.operation().number,
                            region.operation().name()};
            }
        }
    }
    return thinnest;
}

std::optional<FloorBetweenSides> floor_between_sides(const Job& job,
                                                     const std::string& program_file)
{
    if (!can_be_judged(job)) {
        return std::nullopt;
    }
    const double spacing = position_spacing(job);
    const HeightGrid grid = stock_grid(job, part_box({}), std::nullopt);
    MachinedStock stock = UncutStock{job}.on(grid);
    cut_earlier_programs(job, spacing, stock);
    for (const ToolPositions& run : program_positions(job, program_file, spacing)) {
        stock.cut(run, spacing, [](double) {});
    }
    return floor_between_sides(job, grid, stock.heights(), spacing);
}

bool is_too_thin(const Job& job, const FloorBetweenSides& floor)
{
    return floor.thickness < job.least_floor - kCut;
}

std::string sentence_of(const Job& job, const FloorBetweenSides& floor)
{
    const std::string at =
        fmt::format("at x {:.3f} y {:.3f} z {:.3f} mm (operation {}, {})", floor.place.x,
                    floor.place.y, floor.place.z, floor.operation, floor.strategy);
    const std::string what =
        floor.thickness > kCut
            ? fmt::format("{:.2f} mm are left between the cuts of both sides {}", floor.thickness,
                          at)
            : fmt::format("the cuts of both sides meet {}, {:.2f} mm deep in each other", at,
                          std::max(0.0, -floor.thickness));
    return fmt::format(
        "{}; the limit is {:g} mm (least_floor in [stock]; may_open of the operation "
        "allows an opening)",
        what, job.least_floor);
}

}  // namespace cusp::verify
