// Where the axis of a cutter may stand in one layer: inside a field, the radius away from every
// box.
#pragma once

#include <vector>

#include "host_tools/hull_rough/box_union.hpp"

namespace cusp::hull_rough {

struct Interval {
    double begin{};
    double end{};
};

class ClearZone {
public:
    // boxes: what must not be touched; field: where the axis may stand at all; radius of the
    // cutter, > 0.
    ClearZone(const std::vector<Rectangle>& boxes, const Rectangle& field, double radius);

    // The stretches of the level line at y where the axis may stand, ascending in x. Exact: the
    // union of the boxes grown by the radius is the union of the grown boxes.
    std::vector<Interval> on_line(double y) const;

    // True where the axis may move straight from a to b: the swept cutter meets no box. Exact.
    bool clear(Vec2d a, Vec2d b) const { return distance_holds(a, b, radius_); }

    // The same for a cutter smaller by `less` mm.
    bool nearly_clear(Vec2d a, Vec2d b, double less) const
    {
        return distance_holds(a, b, radius_ - less);
    }

    // True where a cutter grown by `extra` mm meets no box at the point, and the field holds it.
    bool room(Vec2d point, double extra) const;

    const Rectangle& field() const { return field_; }
    double radius() const { return radius_; }

private:
    Rectangle field_;
    double radius_;
    // boxes by the rows, 2 radii high, that they reach into
    std::vector<std::vector<Rectangle>> rows_;

    bool distance_holds(Vec2d a, Vec2d b, double distance) const;
    bool inside_field(Vec2d p) const;
    std::size_t row_at(double y) const;
};

// Distance between the segment and the rectangle; 0 where they meet.
double distance(Vec2d a, Vec2d b, const Rectangle& box);

}  // namespace cusp::hull_rough
