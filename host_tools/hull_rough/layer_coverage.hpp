// What runs leave of a layer that the cutter could clear: looked for square by square.
#pragma once

#include <vector>

#include "host_tools/clearing/layer_toolpath_writer.hpp"
#include "host_tools/hull_rough/box_union.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::hull_rough {

// Squares of the plan view that no run clears.
struct UncoveredSpots {
    std::vector<Rectangle> squares;
    double area{};  // mm^2, of all squares
};

// The squares of `window` that lie wholly within `reach` (mm, > 0) of where the axis may stand, but
// whose middles no run comes within `reach` of. Large squares are decided by the distance of their
// middles and quartered down to a 64th of the reach: a bare strip wider than that is always found.
// Cost: linear in the length of the runs.
UncoveredSpots uncovered_spots(const std::vector<clearing::LayerRun>& runs,
                               const offset::RegionOffset& centres,
                               double reach,
                               const Rectangle& window);

// The parts of the runs that come within `reach` of a bare square. Where the runs clear all that
// can be reached, these parts clear all of the squares.
std::vector<clearing::LayerRun> runs_near(const std::vector<clearing::LayerRun>& runs,
                                          const UncoveredSpots& uncovered,
                                          double reach);

}  // namespace cusp::hull_rough
