// Earlier programs count as cuts too, of no line.
#include <cmath>

#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/level_judgement.hpp"
#include "host_tools/judge/verify/verdict.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::Tool;

void judge_level_operations(Verifying& work)
{
    if (!work.scene.has_levels) {
        return;
    }
    const Job& job = work.job;
    const Scene& scene = work.scene;
    Verification& result = work.result;
    std::vector<EarlierCut> cuts = straight_cuts(
        result.program, [&](int n) -> const Tool& { return tool_of(job, n, work.program_file); });
    for (const std::string& file : earlier_programs(job)) {
        for (EarlierCut& cut : earlier_cuts(job, file)) {
            cut.line = 0;  // of another program
            cuts.push_back(cut);
        }
    }
    result.figures.ball_gouge_max.reset();
    result.figures.wall_gouge_at.reset();
    LevelMaps maps =
        judge_levels({job, result.grid, work.heights, scene.floor_tolerance + kJudgement,
                      scene.plan_tolerance + kJudgement, work.runs, cuts, *work.before},
                     result.figures);
    for (std::size_t k = 0; k < result.left.size(); ++k) {
        if (std::isnan(maps.left[k])) {
            maps.left[k] = result.left[k];
        }
    }
    result.left = std::move(maps.left);
    result.gouge = std::move(maps.gouge);
    result.part = std::move(maps.part);
}

}  // namespace cusp::verify
