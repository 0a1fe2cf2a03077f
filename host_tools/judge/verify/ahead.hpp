// Points that a position of a tool can still cut behind another, by the rows of a grid's columns.
//
// The tool's lower side rises with the distance from its axis. Over a point that is at least as near to the position
// before, which was no higher, everything is cut. A ball that sinks by d reaches as far back as a point whose squared
// distance from it is greater by 2 r d: the difference of its heights over two such points is at least d.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

class Ahead {
public:
    // before  has cut, or is over all stock; null: every point is ahead
    Ahead(const toolpath::Tool& tool, Vec3d tip, const Vec3d* before, const HeightGrid& grid)
        : tip_y_{tip.y}
    {
        const double sunk = before != nullptr ? std::max(0.0, before->z - tip.z) : 0.0;
        const bool is_ball = flat_radius(tool) <= 0 && tool.corner_radius > 0 && !is_conical(tool);
        if (before == nullptr || (sunk > 0 && !is_ball)) {
            return;
        }
        constexpr double kRounding = 1e-9;  // mm^2
        const Vec2d step = in_plan(tip) - in_plan(*before);
        const double back = dot(step, step) + 2 * tool.radius * sunk + kRounding;
        // of a point from the tip, along the step; points of a column lie up to half a pitch beside it
        const double least = -back / 2 - std::abs(step.x) * grid.pitch / 2;
        if (std::abs(step.y) > kRounding) {
            side_ = step.y > 0 ? 1 : -1;
            at_axis_ = least / step.y;
            slope_ = -step.x / step.y;
        }
    }

    // Leaves out rows of the column at `x` from the tip that are behind.
    void narrow(const GridRows& rows, double x, std::size_t& first, std::size_t& last) const
    {
        const double y = tip_y_ + at_axis_ + slope_ * x;
        if (side_ > 0) {
            first = std::max(first, rows.first(y));
        } else if (side_ < 0) {
            last = std::min(last, rows.end(y));
        }
    }

private:
    double tip_y_;
    double at_axis_{};
    double slope_{};
    int side_{0};  // of a column's limit that is ahead; 0: both
};

}  // namespace cusp::verify
