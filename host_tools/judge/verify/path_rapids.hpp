// Planned paths, before they are written: rapid moves against the stock that is left by then.
//
//     if (const auto rapid = deepest_rapid(job, paths)) { rapid->depth; }  // it would break a tool
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"

namespace cusp::verify {

struct PathRapid {
    double depth;  // mm along the axis
    std::size_t path;
    Vec3d tip;  // where it is that deep
};

// The deepest cut of a rapid move; none up to kRapidCutAllowed. The paths are cut one after the other from the
// job's stock and what earlier programs leave of it, at twice the pitch and the spacing of verify(). Only the surroundings of rapid moves below the stock's top are cut:
// it costs nothing where there are none.
//
// paths  none is null; each starts with a rapid move over the stock
std::optional<PathRapid> deepest_rapid(const job::Job& job,
                                       const std::vector<const toolpath::Toolpath*>& paths);

}  // namespace cusp::verify
