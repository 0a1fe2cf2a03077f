// A ball dropped on the points of a height map: quick, and never too high.
#pragma once

#include <vector>

#include "host_tools/drop_cutter/lowest_position_search.hpp"
#include "host_tools/verify/height_grid.hpp"

namespace cusp::verify {

// Between points the ball sinks in by a part of the pitch's square over its radius, more beside
// cliffs. A point that stops it stops it on the floor, too.
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
