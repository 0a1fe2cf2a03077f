// The clear zone of one layer: the points of a field that are at least the cutter's radius from
// every box.
#pragma once

#include <vector>

#include "host_tools/cam/hull_rough/box_union.hpp"

namespace cusp::hull_rough {

struct Interval {
    double begin{};
    double end{};
};

class ClearZone {
public:
    // boxes   not to be touched
    // field   limits of the axis
    // radius  mm, > 0, of the cutter
    ClearZone(const std::vector<Rectangle>& boxes, const Rectangle& field, double radius);

    // The intervals of the line at y in the zone, in order of x. Exact: the union of the boxes,
    // grown by the radius, is the union of the grown boxes.
    std::vector<Interval> on_line(double y) const;

    // True if the straight move of the axis from a to b stays in the zone. Exact.
    bool clear(Vec2d a, Vec2d b) const { return distance_holds(a, b, radius_); }

    // True if it does for a cutter smaller by `shrink` mm.
    bool nearly_clear(Vec2d a, Vec2d b, double shrink) const
    {
        return distance_holds(a, b, radius_ - shrink);
    }

    // True if a cutter grown by `extra` mm touches no box at the point, and the field holds it.
    bool room(Vec2d point, double extra) const;

    const Rectangle& field() const { return field_; }
    double radius() const { return radius_; }

private:
    Rectangle field_;
    double radius_;
    // Boxes by rows, 2 radii high, that they intersect.
    std::vector<std::vector<Rectangle>> rows_;

    bool distance_holds(Vec2d a, Vec2d b, double distance) const;
    bool inside_field(Vec2d p) const;
    std::size_t row_at(double y) const;
};

// Distance between the segment and the rectangle, mm; 0 where they intersect.
double distance(Vec2d a, Vec2d b, const Rectangle& box);

}  // namespace cusp::hull_rough
