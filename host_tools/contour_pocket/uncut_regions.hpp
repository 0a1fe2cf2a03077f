// Regions of a pocket that a tool leaves uncut, and how much.
#pragma once

#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::contour_pocket {

struct UncutRegion {
    Vec2d at;         // where it is highest
    double area{};    // mm^2, seen from above
    double height{};  // mm over the floor at most, along the axis
    double volume{};  // mm^3
    bool at_walls{};  // a corner or a neck of the walls; else a valley of the floor
};

// Places of the region that no position of the tool sweeps down to `min_height` (mm) over the
// floor, the largest volume first.
//
//   walls    contours of the region
//   centres  where the tool's axis may be
//   wall_clearance  mm: least distance of these from the contours
//   top      z of the stock: regions at walls reach up to it
//   valleys  false where the floor is known to have none that the tool does not reach
//
// Computed on a grid of a quarter of the tool's radius (coarser in pockets of more than 500 such
// cells a side): areas and volumes are as coarse, heights of valleys good to 0.02 radii. Regions
// smaller than a cell may be missed.
struct UncutSettings {
    double wall_clearance;
    double top;
    double min_height;
    bool valleys;
};
std::vector<UncutRegion> uncut_regions(const offset::RegionOffset& walls,
                                       const offset::Region2d& centres,
                                       const std::vector<nurbs::Surface>& floor,
                                       const drop_cutter::DropCutter& tips,
                                       const UncutSettings& settings);

}  // namespace cusp::contour_pocket
