// A new strategy is one line of the table.
#include "host_tools/cam/strategies/strategies.hpp"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/parallel_planes.hpp"
#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"

namespace cusp::strategies {

const job::Strategies& all()
{
    static const job::Strategies kAll{
        &contour_pocket::kContourPocket,
        &adaptive_isocurve::kAdaptiveIsocurve,
        &grid_pocket::kGridPocket,
        &hull_rough::kHullRough,
        &adaptive_isocurve::kCompleteIsocurves,
        &adaptive_isocurve::kParallelPlanes,
        &contour_pocket::kPocket,
        &prismatic::kProfile,
        &prismatic::kDrill,
        &prismatic::kFace,
        &prismatic::kEngrave,
        &prismatic::kVCarve,
        &prismatic::kChamfer,
    };
    return kAll;
}

std::vector<toolpath::PlannedOperation> plan_operation(const job::Job& job,
                                                       const job::Operation& operation)
{
    const job::Strategy* const strategy = find_strategy(all(), operation.strategy);
    if (strategy == nullptr) {
        throw InputError(job.file + ": strategy \"" + operation.strategy +
                         "\" is not part of this build");
    }
    return strategy->plan(job, operation);
}

}  // namespace cusp::strategies
