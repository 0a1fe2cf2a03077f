// All paths are cut; what each cut says of its rapid moves is kept.
#include "host_tools/judge/verify/path_rapids.hpp"

#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

std::vector<RapidInStock> rapids_in_stock(const Job& job, const std::vector<const Toolpath*>& paths)
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
    std::vector<RapidInStock> rapids;
    if (!stock.look_at_rapids_alone(runs)) {
        return rapids;
    }
    cut_earlier_programs(job, spacing, stock);
    for (std::size_t k = 0; k < runs.size(); ++k) {
        for (const DeepRapid& deep : stock.cut(runs[k], spacing, [](double) {}).deep_rapids) {
            rapids.push_back({k, runs[k].lines[deep.end], deep.depth, runs[k].tips[deep.position],
                              deep.end_depth});
        }
    }
    return rapids;
}

}  // namespace cusp::verify
