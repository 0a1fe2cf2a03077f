// Planned paths, before they are written: the engagement of their tools, and what they remove.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/engagement_trace.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"

namespace cusp::verify {

struct PathEngagement {
    ToolPositions positions;  // `lines` are places of moves in the path
    EngagementRun run;
    double air_mm{};       // of feed moves that remove nothing
    double over_mm{};      // of cuts over the path's limit
    double removed_mm3{};  // by the path
};

// One for each path. They are cut one after the other from what the job's earlier programs leave, on
// the grid and at the spacing of verify().
//
// paths   none is null; each starts with a rapid move
// limits  degrees, of each path
//
// Accuracy: as EngagementTrace; verify() looks at places over a limit again, on finer grids.
std::vector<PathEngagement> path_engagement(const job::Job& job,
                                            const std::vector<const toolpath::Toolpath*>& paths,
                                            const std::vector<std::optional<double>>& limits,
                                            const Progress& progress);

}  // namespace cusp::verify
