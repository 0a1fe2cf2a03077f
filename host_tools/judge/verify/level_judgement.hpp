// The stock after cutting compared with what 2.5-D operations ask for: cut through walls, below
// levels, left on levels, tabs.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/standing_stock.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

struct LevelQuestion {
    const job::Job& job;
    const HeightGrid& grid;
    const std::vector<double>& cut;  // heights of the stock after cutting; NaN: no stock to judge
    double floor_tolerance;          // mm, with the error of the judgement
    double plan_tolerance;           // likewise
    const std::vector<ToolPositions>& runs;
    const std::vector<EarlierCut>& cuts;  // of the program, and of those before it
    const StandingStock& stock;           // before the program
};

// Per grid point, as FloorMaps.
struct LevelMaps {
    std::vector<double> left;
    std::vector<double> gouge;
    std::vector<double> part;
};

// Fills gouge_max, wall_gouge_max, level_left, wall_stock and the tabs of the figures.
//
// A point of the grid may be cut where some operation may cut, no deeper than that operation; what earlier programs cut
// is theirs. A point has to be cut where its operation's tool comes, away from its walls by more than a pitch.
LevelMaps judge_levels(const LevelQuestion& question, VerifyFigures& figures);

}  // namespace cusp::verify
