// The deepest rapid move of all operations is named.
#include "host_tools/cli/rapid_refusal.hpp"

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/judge/verify/path_rapids.hpp"

#include "fmt/format.h"

namespace cusp::cli {

void refuse_rapids(const job::Job& job, const Plan& plan)
{
    cancellation::set_work("checking rapid moves");
    const auto rapid = verify::deepest_rapid(job, paths_of(plan));
    if (!rapid) {
        return;
    }
    const toolpath::PlannedOperation& operation = plan.operations[rapid->path];
    throw InputError(fmt::format(
        "{}: operation {}, {}: a rapid move of tool {} to x {:.3f} y {:.3f} z {:.3f} mm would cut "
        "{:.4g} mm deep into "
        "stock that is there by then, the limit is {:g}: let an operation before it cut that stock "
        "away, or begin this "
        "one at its top",
        job.file, operation.operation, operation.stats.strategy, operation.path.tool.number,
        rapid->tip.x, rapid->tip.y, rapid->tip.z, rapid->depth, verify::kRapidCutAllowed));
}

}  // namespace cusp::cli
