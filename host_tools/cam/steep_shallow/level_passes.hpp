// Waterline passes: level loops as far apart as the scallop allows, or one spiral of them.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/steep_shallow/finish_completion.hpp"
#include "host_tools/cam/steep_shallow/level_curves.hpp"

namespace cusp::steep_shallow {

// The step down from a level that makes the shortest way: where ground allows less, there are levels
// between, each half as far apart as those before, which run over that ground only.
//
// loops   of the level
// widest  mm: the most that is returned, and that where no ground is in the area
double step_down(const std::vector<LevelLoop>& loops, double widest);

// The levels alone.
//
// area  where they run, with a step beyond its border
// Returns the stepover on flat ground, mm.
//
// Errors: InputError where there would be more than 20 000 levels.
double cut_levels(const job::Job& job,
                  const job::Operation& operation,
                  const finishing::SurfaceOperation& work,
                  const finishing::FinishArea& area,
                  FinishCompletion& passes);

}  // namespace cusp::steep_shallow
