// The table of strategies; a new one is one line.
#include "host_tools/cam/strategies/strategies.hpp"

#include <array>

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/parallel_planes.hpp"
#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"

namespace cusp::strategies {

using adaptive_isocurve::plan_adaptive_isocurve;
using adaptive_isocurve::plan_complete_isocurves;
using adaptive_isocurve::plan_parallel_planes;
using contour_pocket::plan_contour_pocket;
using grid_pocket::plan_grid_pocket;
using hull_rough::plan_hull_rough;
using job::Job;
using job::Operation;
using toolpath::PlannedOperation;

namespace {

struct Strategy {
    const char* name;
    std::vector<PlannedOperation> (*plan)(const Job&, const Operation&);
};

// The contour pocket of a level floor, from its own top down.
std::vector<PlannedOperation> plan_pocket(const Job& job, const Operation& operation)
{
    Job from_top = job;
    from_top.operations.clear();
    from_top.stock_top = operation.prismatic->top;
    from_top.clearance = job.stock_top + job.clearance - from_top.stock_top;
    return plan_contour_pocket(from_top, operation);
}

constexpr std::array kStrategies{
    Strategy{"adaptive_isocurve", plan_adaptive_isocurve},
    Strategy{"complete_isocurves", plan_complete_isocurves},
    Strategy{"chamfer", prismatic::plan_chamfer},
    Strategy{"contour_pocket", plan_contour_pocket},
    Strategy{"drill", prismatic::plan_drill},
    Strategy{"engrave", prismatic::plan_engrave},
    Strategy{"face", prismatic::plan_face},
    Strategy{"grid_pocket", plan_grid_pocket},
    Strategy{"hull_rough", plan_hull_rough},
    Strategy{"parallel_planes", plan_parallel_planes},
    Strategy{"pocket", plan_pocket},
    Strategy{"profile", prismatic::plan_profile},
    Strategy{"v_carve", prismatic::plan_v_carve},
};

}  // namespace

std::vector<PlannedOperation> plan_operation(const Job& job, const Operation& operation)
{
    for (const Strategy& strategy : kStrategies) {
        if (operation.strategy == strategy.name) {
            return strategy.plan(job, operation);
        }
    }
    throw InputError(job.file + ": strategy \"" + operation.strategy +
                     "\" is not part of this build");
}

}  // namespace cusp::strategies
