// The verdict in words, and the moves that are to blame.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

// mm: accuracy of the chords of walls and of the height map; added to each limit.
inline constexpr double kJudgement = 5e-4;

// Gives gouges that break a bound the line and the tool of the move that cuts lowest there.
void find_fault_places(const std::vector<ToolPositions>& runs, Verification& result);

// Fills `broken`.
//
// scallop  the bound in mm; none where no operation has one
void judge(const job::Job& job, std::optional<double> scallop, Verification& result);

}  // namespace cusp::verify
