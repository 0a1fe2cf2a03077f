// Cuts the paths as verify() cuts a program.
#include "host_tools/verify/path_engagement.hpp"

#include "host_tools/verify/earlier_programs.hpp"
#include "host_tools/verify/path_positions.hpp"
#include "host_tools/verify/stock_grid.hpp"
#include "host_tools/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

std::vector<PathEngagement> path_engagement(const Job& job,
                                            const std::vector<const Toolpath*>& paths,
                                            const Progress& progress)
{
    const double spacing = position_spacing(job);
    const HeightGrid grid = stock_grid(job, floors_box(job), std::nullopt);
    MachinedStock stock = UncutStock{job}.on(grid);
    cut_earlier_programs(job, spacing, stock);
    std::vector<PathEngagement> out;
    double removed = stock.removed_volume();
    for (std::size_t k = 0; k < paths.size(); ++k) {
        PathEngagement& found = out.emplace_back();
        found.positions = positions_on(*paths[k], spacing);
        EngagementTrace trace{grid, found.positions};
        stock.cut(
            found.positions, spacing,
            [&](double share) {
                progress((static_cast<double>(k) + share) / static_cast<double>(paths.size()));
            },
            &trace);
        found.run = trace.finish();
        for (std::size_t i = 1; i < found.run.kinds.size(); ++i) {
            if (found.run.kinds[i] == StepKind::kAir) {
                found.air_mm += norm(found.positions.tips[i] - found.positions.tips[i - 1]);
            }
        }
        found.removed_mm3 = stock.removed_volume() - removed;
        removed = stock.removed_volume();
    }
    return out;
}

}  // namespace cusp::verify
