// Checks of paths through a region, other than loops.
#pragma once

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::clearing {

// True if the whole path lies in the region with `clearance` (mm, >= 0) from its contours, to 1e-5
// mm, since links between loops start at exactly that distance. With a `clearance` below 0.1 mm
// thin spikes between two samples 0.002 mm apart are missed.
bool is_path_clear(const offset::RegionOffset& region, const offset::Edge& way, double clearance);

}  // namespace cusp::clearing
