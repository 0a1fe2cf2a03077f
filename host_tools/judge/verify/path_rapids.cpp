// The deepest rapid move of each path; the first of those that are alike.
#include "host_tools/judge/verify/path_rapids.hpp"

#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

std::optional<PathRapid> deepest_rapid(const Job& job, const std::vector<const Toolpath*>& paths)
{
    // Twice verify()'s pitch and spacing: an eighth of its work.
    constexpr double kCoarser = 2;
    const double spacing = kCoarser * position_spacing(job);
    std::vector<ToolPositions> runs;
    for (const Toolpath* path : paths) {
        runs.push_back(positions_on(*path, spacing));
    }
    const PartBox floors = floors_box(job);
    const double pitch = kCoarser * stock_grid(job, floors, std::nullopt).pitch;
    MachinedStock stock = UncutStock{job}.on(stock_grid(job, floors, pitch));
    std::optional<PathRapid> deepest;
    if (!stock.look_at_rapids_alone(runs)) {
        return deepest;
    }
    cut_earlier_programs(job, spacing, stock);
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const CutFigures cut = stock.cut(runs[k], spacing, [](double) {});
        if (cut.rapid_cut > (deepest ? deepest->depth : kRapidCutAllowed)) {
            deepest = PathRapid{cut.rapid_cut, k, runs[k].tips[cut.rapid_position]};
        }
    }
    return deepest;
}

}  // namespace cusp::verify
