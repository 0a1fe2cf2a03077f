// Cleanup spurs: short detours of a loop into the corners that it and the loop outside it leave
// uncut.
#pragma once

#include <cstddef>
#include <optional>

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::clearing {

// Distances of a ring and of the strip left by the ring outside it, mm.
struct CleanupSpace {
    double wall_distance;  // of the ring outside from the walls: spurs keep it too
    double reach;          // width cut on either side of a pass
    double depth;          // from the border of the strip, at wall_distance + reach, to the ring
};

// The ring with a cleanup spur (out and back on a straight line) wherever part of the strip between
// it and `border` is farther than `reach` from it, so that afterwards none is. The border is
// sampled every quarter of `reach` and at its corners, and so are the points where lines inward
// from there meet. None if straight spurs do not suffice: the ring must be nearer.
std::optional<offset::Region2d> with_corner_cleanup(const offset::Region2d& ring,
                                                    const offset::Region2d& border,
                                                    const offset::RegionOffset& source,
                                                    const CleanupSpace& space);

// True if a detour out and back on one line starts with the edge.
bool starts_cleanup_spur(const offset::Contour& contour, std::size_t edge);

}  // namespace cusp::clearing
