// At the tips of all positions, which lie within the spacing.
#include "host_tools/job/job/fixture_clearance.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

#include "fmt/format.h"

namespace cusp::verify {

void judge_fixtures(Verifying& work)
{
    VerifyFigures& figures = work.result.figures;
    for (const job::Fixture& fixture : work.job.fixtures) {
        double& deepest = figures.fixture_hit_max.emplace(figures.fixture_hit_max.value_or(0));
        for (const ToolPositions& run : work.runs) {
            for (const Vec3d tip : run.tips) {
                const double inside = -distance_to(fixture, run.tool.radius, tip);
                if (inside > deepest) {
                    deepest = inside;
                    figures.fixture_hit_at = fmt::format("{} at x {:.3f} y {:.3f} z {:.3f}",
                                                         fixture.name, tip.x, tip.y, tip.z);
                }
            }
        }
    }
}

}  // namespace cusp::verify
