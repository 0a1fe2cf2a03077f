// Roughing before adaptive isocurves: parallel planes slice the offset of the model, and each level
// is cleared like a pocket.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::adaptive_isocurve {

// Levels of equal depth from the top of the stock down to the lowest place of the model
// (`rough_depths`: max_depth, min_depth, layers), for the tools of operation.tools, of any shapes,
// the largest first: one result for each that finds metal, none where none fits into the stock.
// operation.allowance stays on the model, along its normal.
//
// A smaller tool cuts where it reaches deeper than a quarter of the ridges below what the larger
// ones left. Beside walls it keeps off by as much more as their slices may have kept, so that it
// does not follow them for a sliver.
//
// No place of the tool's axis leaves the slices of `WaterlineSlices`, so no cut comes nearer to the
// model than the allowance; each move is measured against the model once more, and
// stats.gouge_bound_mm comes from that. A slice lies in the one above, so no cut is deeper than
// max_depth, ridges between passes of a ball and what tools leave to each other included.
//
// Errors: InputError where depth, tool or tolerance can't be used, or nothing is to be roughed.
// Source: Elber & Cohen 1993, section 4.
std::vector<toolpath::PlannedOperation> plan_waterline_roughing(const job::Job& job,
                                                                const job::Operation& operation);

}  // namespace cusp::adaptive_isocurve
