// Roughing before adaptive isocurves: parallel planes slice the offset of the model, and each level
// is cleared like a pocket.
#pragma once

#include "host_tools/import/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

// Levels no deeper than operation.max_depth each (or at operation.layers) from the top of the stock
// down to the lowest place of the model, for the tool operation.tools.front(), of any shape.
// operation.allowance stays on the model, along its normal.
//
// No place of the tool's axis leaves the slices of `LevelSlices`, so no cut comes nearer to the
// model than the allowance; each move is measured against the model once more, and
// stats.gouge_bound_mm comes from that. A slice lies in the one above, so no cut is deeper than
// max_depth, ridges between passes of a ball included.
//
// Errors: InputError where depth, tool or tolerance can't be used, or nothing is to be roughed.
// Source: Elber & Cohen 1993, section 4.
PlannedOperation plan_rough_levels(const Job& job, const Operation& operation);

}  // namespace cusp::host
