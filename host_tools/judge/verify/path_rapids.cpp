// Curves are their chords.
#include "host_tools/judge/verify/path_rapids.hpp"

#include "host_tools/judge/verify/deep_rapids.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

std::vector<RapidInStock> rapids_in_stock(const Job& job, const std::vector<const Toolpath*>& paths)
{
    std::vector<ToolPositions> runs;
    for (const Toolpath* path : paths) {
        runs.push_back(positions_on(*path, kUnbounded));
    }
    std::vector<RapidInStock> rapids;
    for (const RapidOfRun& rapid : deep_rapids(job, runs, position_spacing(job),
                                               stock_box(job, floors_box(job)), RapidCut::kAtEnd)) {
        rapids.push_back({rapid.run, rapid.line, rapid.depth, rapid.tip, rapid.end_depth});
    }
    return rapids;
}

}  // namespace cusp::verify
