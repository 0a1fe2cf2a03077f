// How far a floor can rise above a chord between two looked-at places, proven from its control
// points.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::grid_pocket {

// The floor as a height z(x, y): over a straight way of length s in plan it rises above its chord
// by no more than max_bend() s^2 / 8, and so does the tip of any tool over it, since that is the
// highest of many heights of the floor, each moved along by the same way (a floor that bends down
// by at most K makes tips that bend down by at most K). That fails only where the floor ends, has a
// ridge, or is steeper than a height can be: is_bent_near() tells.
class GridHeightBounds {
public:
    // reach  mm: of the tool, from its axis to what it may touch
    GridHeightBounds(const std::vector<nurbs::Surface>& floor, double reach);

    double max_bend() const { return max_bend_; }  // 1/mm

    // Whether such a place may lie within reach of the box.
    bool is_bent_near(const offset::Box2d& box) const;

private:
    double reach_;
    double max_bend_{0};
    offset::Box2d field_;
    double bin_{};
    int columns_{};
    int rows_{};
    std::vector<bool> bent_;

    void mark(const offset::Box2d& box);
};

}  // namespace cusp::grid_pocket
