// Rapid moves in stock of any size: it is cut in tiles, so that the pitch does not depend on its extent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

struct RapidOfRun {
    std::size_t run;
    std::uint32_t line;  // of the run, in which the rapid move is
    double depth;        // mm along the axis: the deepest
    Vec3d tip;           // where it is that deep
    double end_depth;    // mm: stock over the tool at the end of the move
};

// The rapid moves that cut deeper than kRapidCutAllowed into what earlier programs and earlier positions leave, in the
// order of runs and lines. Tiles without a rapid move below the stock's top are not cut.
//
// runs     with lines; a line has one rapid move, or the worst of its counts
// spacing  mm between positions
// grid     of the whole stock, of any number of points
std::vector<RapidOfRun> deep_rapids(const job::Job& job,
                                    const std::vector<ToolPositions>& runs,
                                    double spacing,
                                    const HeightGrid& grid,
                                    RapidCut rapids);

}  // namespace cusp::verify
