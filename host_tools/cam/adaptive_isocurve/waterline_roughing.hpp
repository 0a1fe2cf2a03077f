// Waterline roughing before adaptive isocurves: horizontal planes slice the offset of the model,
// and each slice is cleared like a pocket.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_isocurve/level_floors.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

// Levels of equal depth from the top of the stock down to the lowest point of the model
// (`rough_depths`: max_depth, min_depth, layers), for operation.tools of any shapes, the largest
// first. One result for each tool that finds stock; where none does, one without moves.
// operation.allowance stays on the model, along its normal, but for the floors, which their tool cuts to
// size after its levels.
//
// Rest machining: a smaller tool cuts where it removes more than a quarter of the scallop height.
// It keeps off walls by as much more as the slices of larger tools may have, so that it does not
// follow walls for a sliver.
//
// The tool's axis never leaves the slices of `WaterlineSlices`, so no cut is nearer to the model
// than the allowance. stats.gouge_bound_mm is from a separate measurement of each move. A slice
// lies in the one above, so no cut is deeper than max_depth, scallops and rests of other tools
// included.
//
// Errors: InputError where depth, tool or tolerance cannot be used.
// Source: Elber & Cohen 1993, section 4.
std::vector<toolpath::PlannedOperation> plan_waterline_roughing(const job::Job& job,
                                                                const job::Operation& operation,
                                                                const LevelFloors& floors = {});

}  // namespace cusp::adaptive_isocurve
