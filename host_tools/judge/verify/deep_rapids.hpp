// Rapid moves in stock, measured exactly along them: level ones, plunges and slopes, through blocks and thin walls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

// The cut of a rapid move, before the moves after it: all along, or as if the tool had come to its end from above.
enum class RapidCut { kAlong, kAtEnd };

struct RapidOfRun {
    std::size_t run;
    std::uint32_t line;  // of the run, in which the rapid move is
    double depth;        // mm along the axis: the deepest
    Vec3d tip;           // where it is that deep
    double end_depth;    // mm: stock over the tool at the end of the move
};

// The rapid moves that cut deeper than kRapidCutAllowed into what earlier programs and earlier positions leave, in the
// order of runs and lines. It costs little where none of them is below the stock's top.
//
// runs     with lines; a line has one rapid move, or the worst of its counts
// spacing  mm between positions of earlier programs, on curves
// box      of the whole stock
std::vector<RapidOfRun> deep_rapids(const job::Job& job,
                                    const std::vector<ToolPositions>& runs,
                                    double spacing,
                                    const PartBox& box,
                                    RapidCut rapids);

}  // namespace cusp::verify
