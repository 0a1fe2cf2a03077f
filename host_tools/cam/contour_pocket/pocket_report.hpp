// Statistics and warnings of a planned pocket: cuts above the stock, depth of cut, uncut stock.
#pragma once

#include <vector>

#include "host_tools/cam/clearing/axial_depth_tracker.hpp"
#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// Warns if no cut is below the stock's top (z).
void report_air(const std::vector<toolpath::ToolMove>& moves,
                double stock_top,
                toolpath::OperationStats& stats);

// Adds the deepest cut if the depth is limited, and warns if it exceeds the limit.
void report_depth(const clearing::AxialDepthTracker& depth, toolpath::OperationStats& stats);

// Adds area, number, volume and height of the regions that the tool does not reach, and names the
// largest.
//
// walls    of the region
// valleys  false if the tool reaches all of the floor
// air      part of the region beside the stock: nothing stays there
void report_uncut(const Pocket& pocket,
                  const offset::RegionOffset& walls,
                  const drop_cutter::DropCutter& floor,
                  bool valleys,
                  const offset::Region2d& air,
                  toolpath::OperationStats& stats);

}  // namespace cusp::contour_pocket
