// A tool with a flat end over the floor: heights by bounds, and the room that straight moves keep.
#pragma once

#include <optional>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/grid_pocket/grid_height_bounds.hpp"

namespace cusp::grid_pocket {

class FlatEndDropCutter {
public:
    // accuracy  mm, > 0: how much too high heights may be; never too low
    FlatEndDropCutter(const std::vector<nurbs::Surface>& floor,
                      const toolpath::Tool& tool,
                      double accuracy);

    std::optional<double> height(Vec2d at) const;

    // Lower bound, at most 0, of how far the tip stays over the height of the floor's tips on a
    // straight move. Far from the floor's ends and ridges by GridHeightBounds; near them every
    // piece of the move is compared with the drop of a tool so much wider that it holds the tool
    // all along the piece.
    double move_clearance(Vec3d a, Vec3d b) const;

private:
    drop_cutter::DropCutter floor_;
    drop_cutter::DropCutter wide_;
    GridHeightBounds bend_;
    double wider_;
    mutable Vec3d known_{1e300, 0, 0};  // the last end of a move with its height

    double over(Vec3d tip) const;
    double clearance_between(Vec3d a, double over_a, Vec3d b, double over_b) const;
};

}  // namespace cusp::grid_pocket
