// Straight moves to slivers that are left between passes.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_clearing {

struct SliverSpace {
    const std::vector<Vec2d>& places;  // where the tool has been
    const offset::RegionOffset& walls;
    const offset::EdgeTree& centres;  // contours of the region of the tool's centre
    double wall_clearance;            // mm: of the tool's centre
    double tool_radius;               // mm
};

// From the nearest place that has a clear way: towards the sliver, else to the place next to it.
std::optional<offset::Edge> move_to_sliver(Vec2d sliver, const SliverSpace& space);

}  // namespace cusp::adaptive_clearing
