// Short ways out of a loop into the corners that it and the loop outside it leave between them.
#pragma once

#include <cstddef>
#include <optional>

#include "host_tools/offset/offset.hpp"

namespace cusp::clearing {

// Distances of a level and of what the level outside it has left, mm.
struct CleanupSpace {
    double wall_distance;  // of the level outside from the walls: spurs keep it, too
    double reach;          // what a pass cuts on either side
    double depth;          // from the border of the rest, at room + reach, to the level
};

// The level with a spur (out and back on a straight line) wherever some of the rest between it and
// `border` lies farther than `reach` from it, so that afterwards none does. The border is looked at
// every quarter of `reach` and at its corners; so is where ways inward from there meet each other.
// Returns no value where straight spurs do not suffice: the level must come nearer.
std::optional<offset::Region2d> with_corner_cleanup(const offset::Region2d& level,
                                                    const offset::Region2d& border,
                                                    const offset::RegionOffset& source,
                                                    const CleanupSpace& space);

// Whether a way out and back on one line starts with the edge.
bool starts_cleanup_spur(const offset::Contour& contour, std::size_t edge);

}  // namespace cusp::clearing
