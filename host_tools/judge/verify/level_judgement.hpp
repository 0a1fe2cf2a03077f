// The stock after cutting compared with what 2.5-D operations ask for: cut through walls, below
// levels, left on levels, tabs.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

struct LevelQuestion {
    const job::Job& job;
    const HeightGrid& grid;
    const std::vector<double>& cut;  // heights of the stock after cutting; NaN: no stock to judge
    double floor_tolerance;          // mm, with the error of the judgement
    double plan_tolerance;           // likewise
};

// Per grid point, as FloorMaps.
struct LevelMaps {
    std::vector<double> left;
    std::vector<double> gouge;
    std::vector<double> part;
};

// Fills gouge_max, wall_gouge_max, level_left and the tabs of the figures.
//
// A point of the grid may be cut where some operation may cut, no deeper than that operation. A
// point has to be cut where its operation's tool comes, away from its walls by more than a pitch.
LevelMaps judge_levels(const LevelQuestion& question, VerifyFigures& figures);

}  // namespace cusp::verify
