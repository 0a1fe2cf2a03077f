// Ways through a region that are not loops.
#pragma once

#include "host_tools/offset/offset.hpp"

namespace cusp::clearing {

// Whether all of the way lies in the region and `clearance` (mm, >= 0) off its contours, but for
// 1e-5 mm: ways from loop to loop start at just that distance. Where `clearance` is below 0.1 mm,
// what a thin spike between two places 0.002 mm apart takes is not seen.
bool is_path_clear(const offset::RegionOffset& region, const offset::Edge& way, double clearance);

}  // namespace cusp::clearing
