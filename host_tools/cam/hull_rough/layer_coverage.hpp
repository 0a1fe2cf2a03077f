// Spots of a layer that the cutter could clear and its runs leave, found square by square.
#pragma once

#include <vector>

#include "host_tools/cam/clearing/layer_toolpath_writer.hpp"
#include "host_tools/cam/hull_rough/box_union.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::hull_rough {

// Squares in plan that no run clears.
struct UncoveredSpots {
    std::vector<Rectangle> squares;
    double area{};  // mm^2, of all squares
};

// The squares of `window` that lie wholly within `reach` (mm, > 0) of the region of the axis, with
// no run within `reach` of their middles. Large squares are decided by the distance of their
// middles, or quartered down to a 64th of the reach: an uncovered strip wider than that is always
// found. Cost: linear in the length of the runs.
UncoveredSpots uncovered_spots(const std::vector<clearing::LayerRun>& runs,
                               const offset::RegionOffset& centres,
                               double reach,
                               const Rectangle& window);

// The parts of the runs within `reach` of an uncovered square. If the runs clear everything that
// can be reached, these parts clear all the squares.
std::vector<clearing::LayerRun> runs_near(const std::vector<clearing::LayerRun>& runs,
                                          const UncoveredSpots& uncovered,
                                          double reach);

}  // namespace cusp::hull_rough
