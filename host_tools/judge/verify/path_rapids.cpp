// All paths are cut; what each cut says of its rapid moves is kept.
#include "host_tools/judge/verify/path_rapids.hpp"

#include "host_tools/judge/verify/deep_rapids.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

std::vector<RapidInStock> rapids_in_stock(const Job& job, const std::vector<const Toolpath*>& paths)
{
    // Twice verify()'s spacing, half of its work. Its pitch: what stands beside two cuts may be thinner than twice that.
    constexpr double kCoarser = 2;
    const double spacing = kCoarser * position_spacing(job);
    std::vector<ToolPositions> runs;
    for (const Toolpath* path : paths) {
        runs.push_back(positions_on(*path, spacing));
    }
    const PartBox floors = floors_box(job);
    std::vector<RapidInStock> rapids;
    for (const RapidOfRun& rapid :
         deep_rapids(job, runs, spacing, stock_grid(job, floors, std::nullopt, kUnbounded),
                     RapidCut::kAtEnd)) {
        rapids.push_back({rapid.run, rapid.line, rapid.depth, rapid.tip, rapid.end_depth});
    }
    return rapids;
}

}  // namespace cusp::verify
