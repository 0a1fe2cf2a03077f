// Figures of a program's engagement: the greatest, the length over a limit, the length in air, and
// the removal rate.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/engagement_trace.hpp"
#include "host_tools/judge/verify/program_moves.hpp"

namespace cusp::verify {

struct EngagementFigures {
    double angle_max{};                 // degrees, on feed moves outside entries
    Vec3d place{};                      // the tip there
    std::uint32_t line{};               // of the program; 0: nothing is cut
    std::optional<double> limit;        // degrees; the least, where tools have several
    std::optional<double> limited_max;  // degrees: the greatest of tools that have a limit
    std::optional<double> over_length;  // mm of way over the limit; no value without a limit
    double air_length{};                // mm of feed moves that remove nothing
    double removed_volume{};            // mm^3
    double seconds{};                   // of the program
};

// The largest engagement that is allowed to a tool, degrees: `asked` for all tools, else the least
// of the operations of this tool that have one.
std::optional<double> engagement_limit(const job::Job& job,
                                       const toolpath::Tool& tool,
                                       std::optional<double> asked);

// Sets what counts as over in a run: what is over the limit by more than 5 %, and by more than 0.7
// pitches of a straight cut's width, which the grid does not resolve. Nothing without a limit.
void set_limit(const toolpath::Tool& tool,
               std::optional<double> limit,
               double pitch,
               EngagementRun& run);

// Adds a run of one tool. Precondition: set_limit().
void add_engagement(const ToolPositions& positions,
                    std::optional<double> limit,
                    const EngagementRun& run,
                    EngagementFigures& figures);

// Feed moves at their feed, rapid moves at the rates of the controller's default machine; without
// the way to the first position, acceleration and stops.
double programmed_seconds(const Program& program);

}  // namespace cusp::verify
