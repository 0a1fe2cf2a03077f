// Limits of the tools, closer looks where they seem broken, and the sums.
#include "host_tools/judge/verify/engagement.hpp"
#include "host_tools/judge/verify/engagement_windows.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

namespace cusp::verify {

void measure_engagement(Verifying& work)
{
    if (!work.settings.engagement) {
        return;
    }
    const std::vector<ToolPositions>& runs = work.runs;
    Verification& result = work.result;
    EngagementFigures& figures = result.figures.engagement.emplace();
    std::vector<std::optional<double>> limits;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        limits.push_back(engagement_limit(work.job, runs[k].tool, work.settings.max_engagement));
        set_limit(runs[k].tool, limits[k], result.grid.pitch, result.engagement[k]);
    }
    if (!work.settings.pitch) {
        look_closer(work.job, result.grid, work.spacing, runs, result.engagement);
    }
    for (std::size_t k = 0; k < runs.size(); ++k) {
        add_engagement(runs[k], limits[k], result.engagement[k], figures);
    }
    figures.removed_volume = work.stock->removed_volume() - work.removed_before;
    figures.seconds = programmed_seconds(result.program);
}

}  // namespace cusp::verify
