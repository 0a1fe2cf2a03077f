// Drop cutter for a ball on the points of a height map: fast, and never too high.
#pragma once

#include <vector>

#include "host_tools/geometry/drop_cutter/lowest_position_search.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

// Between points the ball is too low by up to a fraction of the squared pitch over its radius, more
// beside cliffs. Thus a ball blocked by the points is blocked by the floor too.
class FloorSamples {
public:
    // heights  of the floor at the grid's points; NaN where there is none
    FloorSamples(const HeightGrid& grid, const std::vector<double>& heights);

    drop_cutter::LowestPositionSearch::DroppedTool drop_ball(double radius,
                                                             double x,
                                                             double y) const;

private:
    const HeightGrid& grid_;
    const std::vector<double>& heights_;
    std::vector<double> shifts_;
};

}  // namespace cusp::verify
