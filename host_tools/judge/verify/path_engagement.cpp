// Cuts the paths as verify() cuts a program.
#include "host_tools/judge/verify/path_engagement.hpp"

#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/engagement.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

std::vector<PathEngagement> path_engagement(const Job& job,
                                            const std::vector<const Toolpath*>& paths,
                                            const std::vector<std::optional<double>>& limits,
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
        set_limit(paths[k]->tool, limits[k], grid.pitch, found.run);
        EngagementFigures figures;
        add_engagement(found.positions, limits[k], found.run, figures);
        found.air_mm = figures.air_length;
        found.over_mm = figures.over_length.value_or(0.0);
        found.removed_mm3 = stock.removed_volume() - removed;
        removed = stock.removed_volume();
    }
    return out;
}

}  // namespace cusp::verify
