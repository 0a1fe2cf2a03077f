// Loops of levels as runs of tips: each on its own, or whole loops above each other as one way down.
#pragma once

#include <vector>

#include "host_tools/cam/steep_shallow/level_curves.hpp"

namespace cusp::steep_shallow {

// Tips in cutting order; between two of them the tool touches the part as well.
using LevelRun = std::vector<Vec3d>;

// The parts of loops in the area. A whole loop ends where it begins.
std::vector<LevelRun> runs_of(const std::vector<LevelLoop>& loops);

// The same, but a whole loop goes down to the next one along it, where that lies everywhere within
// `near` (mm, in plan) of it; the last one is level.
//
// loops   from the top down
// curves  of the loops
std::vector<LevelRun> spirals(const std::vector<LevelLoop>& loops,
                              const LevelCurves& curves,
                              double near);

}  // namespace cusp::steep_shallow
