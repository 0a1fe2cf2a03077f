// What a tool cannot reach in a pocket, and how much stays there.
#pragma once

#include <vector>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::host {

struct RestPlace {
    Vec2d at;         // where most stays
    double area{};    // mm^2, seen from above
    double height{};  // mm over the floor at most, along the axis
    double volume{};  // mm^3
    bool at_walls{};  // a corner or a neck of the walls; else a valley of the floor
};

// Places of the region that no position of the tool sweeps down to `least` (mm) over the floor,
// the largest volume first.
//
//   walls    contours of the region
//   centres  where the tool's axis may be
//   first    mm: least distance of these from the contours
//   top      z of the stock: what walls keep the tool from stands to there
//   valleys  false where the floor is known to have none that the tool does not reach
//
// Looked at on a grid of a quarter of the tool's radius (coarser in pockets of more than 500 such
// cells a side): areas and volumes are as coarse, heights of valleys good to 0.02 radii. Places
// smaller than a cell may be missed.
struct RestSettings {
    double first;
    double top;
    double least;
    bool valleys;
};
std::vector<RestPlace> rest_material(const RegionOffset& walls,
                                     const Region2d& centres,
                                     const std::vector<Surface>& floor,
                                     const TipFloor& tips,
                                     const RestSettings& settings);

}  // namespace cusp::host
