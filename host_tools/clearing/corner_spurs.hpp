// Short ways out of a loop into the corners that it and the loop outside it leave between them.
#pragma once

#include <optional>

#include "host_tools/offset/offset.hpp"

namespace cusp::host {

// The level with a spur (out and back on a straight line) wherever some of `rest` lies farther than
// `reach` from it, so that afterwards none does. `rest` is what the level outside has left: its
// border is looked at every quarter of `reach` and at its corners, where the farthest points are.
// A spur keeps `room` (mm) from the contours of `source`.
// Returns no value where straight spurs do not suffice: the level must come nearer.
std::optional<Region2d> with_corner_spurs(const Region2d& level,
                                          const Region2d& rest,
                                          double reach,
                                          const RegionOffset& source,
                                          double room);

}  // namespace cusp::host
