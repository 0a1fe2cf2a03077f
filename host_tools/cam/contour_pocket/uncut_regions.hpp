// Regions of a pocket that a tool leaves uncut, and their heights.
#pragma once

#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::contour_pocket {

struct UncutRegion {
    Vec2d at;         // its highest place
    double area{};    // mm^2, seen from above
    double height{};  // mm: largest height above the floor, along the axis
    double volume{};  // mm^3
    bool at_walls{};  // a corner or a neck of the walls; else a valley of the floor
};

// Parts of the region that no position of the tool cuts down to `min_height` (mm) above the floor,
// the largest volume first.
//
// walls    contours of the region
// centres  where the tool's axis may be
// floor    the surfaces
// tips     the tool over them
//
// Computed on a grid of a quarter of the tool's radius (coarser in pockets of more than 500 such
// cells a side). Areas and volumes have that resolution, heights of valleys an error of 0.02 radii.
// Regions smaller than a cell may be missed.
struct UncutSettings {
    double wall_clearance;  // mm: least distance of `centres` from the contours
    double top;             // z of the stock: regions at walls reach up to it
    double min_height;
    bool valleys;            // false if the floor has no valley that the tool does not reach
    offset::Region2d air{};  // nothing stays there
};
std::vector<UncutRegion> uncut_regions(const offset::RegionOffset& walls,
                                       const offset::Region2d& centres,
                                       const std::vector<nurbs::Surface>& floor,
                                       const drop_cutter::DropCutter& tips,
                                       const UncutSettings& settings);

}  // namespace cusp::contour_pocket
