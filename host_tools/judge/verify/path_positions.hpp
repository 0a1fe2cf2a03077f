// Planned paths, before they are written, as positions of tools.
#pragma once

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

// mm: of curves, by their chords.
inline constexpr double kPathChord = 1e-3;

// Positions at most `spacing` mm apart; `lines` are places of moves in the path.
ToolPositions positions_on(const toolpath::Toolpath& path, double spacing);

// The box of the floors of all operations.
PartBox floors_box(const job::Job& job);

}  // namespace cusp::verify
