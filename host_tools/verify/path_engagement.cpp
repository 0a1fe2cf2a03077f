// Cuts the paths as verify() cuts a program.
#include "host_tools/verify/path_engagement.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/verify/earlier_programs.hpp"
#include "host_tools/verify/engagement.hpp"
#include "host_tools/verify/engagement_windows.hpp"
#include "host_tools/verify/path_positions.hpp"
#include "host_tools/verify/stock_grid.hpp"
#include "host_tools/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Toolpath;

namespace {

// Sets `over_mm`, and the angles that a finer grid finds.
void find_over(const Job& job,
               const HeightGrid& grid,
               double spacing,
               const std::vector<const Toolpath*>& paths,
               const std::vector<std::optional<double>>& limits,
               std::vector<PathEngagement>& found)
{
    std::vector<ToolPositions> positions;
    std::vector<EngagementRun> runs;
    for (std::size_t k = 0; k < found.size(); ++k) {
        set_limit(paths[k]->tool, limits[k], grid.pitch, found[k].run);
        positions.push_back(found[k].positions);
        runs.push_back(found[k].run);
    }
    look_closer(job, grid, spacing, positions, runs);
    for (std::size_t k = 0; k < found.size(); ++k) {
        EngagementFigures figures;
        add_engagement(positions[k], limits[k], runs[k], figures);
        found[k].over_mm = figures.over_length.value_or(0.0);
        found[k].run = std::move(runs[k]);
    }
}

}  // namespace

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
        for (std::size_t i = 1; i < found.run.kinds.size(); ++i) {
            if (found.run.kinds[i] == StepKind::kAir) {
                found.air_mm += norm(found.positions.tips[i] - found.positions.tips[i - 1]);
            }
        }
        found.removed_mm3 = stock.removed_volume() - removed;
        removed = stock.removed_volume();
    }
    if (std::any_of(limits.begin(), limits.end(), [](const auto& limit) { return limit; })) {
        find_over(job, grid, spacing, paths, limits, out);
    }
    return out;
}

}  // namespace cusp::verify
