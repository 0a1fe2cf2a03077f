// Both kinds of sections are cut by one operation, and judged by one check.
#include "host_tools/cam/steep_shallow/steep_shallow.hpp"

#include <algorithm>
#include <chrono>

#include "host_tools/cam/steep_shallow/finish_completion.hpp"
#include "host_tools/cam/steep_shallow/level_passes.hpp"
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"

namespace cusp::steep_shallow {

using finishing::faceted;
using finishing::FinishArea;
using finishing::SurfaceOperation;
using job::Job;
using job::Operation;
using toolpath::PlannedOperation;

namespace {

constexpr double kLeadIn = 0.5;  // radii

// The operation over ground of these slopes, where it is for them.
Operation limited(const Operation& operation, double least_slope, double most_slope)
{
    Operation out = operation;
    job::GroundRange& range = finish_keys(out).range;
    range.least_slope = std::max(range.least_slope, least_slope);
    range.most_slope = std::min(range.most_slope, most_slope);
    return out;
}

bool is_empty(const Operation& operation)
{
    const job::GroundRange& range = finish_keys(operation).range;
    return range.least_slope >= range.most_slope;
}

std::vector<PlannedOperation> timed(PlannedOperation planned,
                                    std::chrono::steady_clock::time_point begin)
{
    planned.stats.planning_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::vector<PlannedOperation> out;
    out.push_back(std::move(planned));
    return out;
}

}  // namespace

std::vector<PlannedOperation> plan_waterline(const Job& job, const Operation& given)
{
    const auto begin = std::chrono::steady_clock::now();
    check_sizes(job, given);
    const Operation operation = faceted(given);
    SurfaceOperation work{job, operation, operation.part.floor};
    FinishCompletion passes{job, operation, work};
    const double step = cut_levels(job, operation, work, work.area(), passes);
    return timed(passes.finished(step, kLeadIn * operation.tool.radius), begin);
}

std::vector<PlannedOperation> plan_steep_shallow(const Job& job, const Operation& given)
{
    const auto begin = std::chrono::steady_clock::now();
    check_sizes(job, given);
    const Operation operation = faceted(given);
    const double steep_from = finish_keys(operation).steep_from;
    SurfaceOperation work{job, operation, operation.part.floor};
    FinishCompletion passes{job, operation, work};
    double step = 0;
    if (const Operation steep = limited(operation, steep_from, 90); !is_empty(steep)) {
        step = cut_levels(job, steep, work, FinishArea{steep, work.area().margin()}, passes);
    }
    if (const Operation shallow = limited(operation, 0, steep_from); !is_empty(shallow)) {
        step = cut_planes(job, shallow, work, FinishArea{shallow, work.area().margin()}, passes);
    }
    return timed(passes.finished(step), begin);
}

}  // namespace cusp::steep_shallow
