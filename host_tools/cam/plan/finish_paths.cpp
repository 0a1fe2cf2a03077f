// Each path keeps off fixtures and counts its rounding, whatever strategy planned it.
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/toolpath/post.hpp"
#include "host_tools/job/job/fixture_clearance.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::Operation;
using toolpath::added_rounding;
using toolpath::PlannedOperation;

namespace {

// Adds the post's rounding to the bounds that the planner computed, and says so in the header.
void add_rounding(const Job& job, PlannedOperation& operation)
{
    const double added = added_rounding(job.post, job.inch);
    if (!(added > 0)) {
        return;
    }
    operation.stats.gouge_bound_mm += added;
    operation.stats.scallop_bound_mm += added;
    operation.path.comments.push_back(
        fmt::format("rounded to {} decimals: both bounds are {:.4f} mm more",
                    job.post.decimals(job.inch), added));
}

}  // namespace

void finish_paths(Planning& planning)
{
    const Job& job = planning.job;
    for (Planned& planned : planning.planned) {
        const Operation& operation = job.operations[planned.place];
        for (PlannedOperation& path : planned.paths) {
            path.operation = operation.number;
            if (path.path.moves.empty() && !path.stats.rest) {
                continue;
            }
            path.stats.retracts += keep_off_fixtures(
                job, fmt::format("operation {}, {}", operation.number, operation.name()),
                path.path);
            add_rounding(job, path);
        }
    }
}

}  // namespace cusp::plan
