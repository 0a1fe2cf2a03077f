// Each operation is planned by its own strategy.
#include "host_tools/cam/strategies/strategies.hpp"

#include <string>

#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::strategies {

std::vector<toolpath::PlannedOperation> plan_operation(const job::Job& job,
                                                       const job::Operation& operation)
{
    if (operation.strategy->plan == nullptr) {
        throw InputError(job.file + ": operation " + std::to_string(operation.number) +
                         " has no strategy");
    }
    return operation.strategy->plan(job, operation);
}

}  // namespace cusp::strategies
