// The volume that a tool sweeps on a straight move. It is convex and open upwards, so four corners
// bound its lower side over a square from above, and a tangent plane bounds it from below.
#pragma once

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::rest_machining {

// The lower side of a tool end: a level bottom, then a round corner or a slanted flank.
struct EndProfile {
    double radius{};  // mm: of the tool
    double flat{};    // mm: of the level bottom
    double corner{};  // mm: of the corner
    double rise{};    // slope of a flank, mm per mm outward; 0: none
    double join{};    // mm: from the flat bottom to where the flank leaves the corner
    double joined{};  // mm: its height there
    double raised{};  // mm: height of a shrunk tool's tip over the tool's tip

    // The profile of what lies deeper than `shrink` inside the tool; 0: the tool.
    explicit EndProfile(const toolpath::Tool& tool, double shrink = 0);

    double height(double distance) const;  // mm over the tip; distance up to the radius
    double slope(double distance) const;   // mm a mm, from the inside
};

// z = z at a place, and its slope
struct SupportPlane {
    Vec2d place;
    double z;
    Vec2d slope;

    double at(Vec2d p) const { return z + dot(slope, p - place); }
};

class ToolSweep {
public:
    // from, to  of the tip, mm
    ToolSweep(const EndProfile& end, Vec3d from, Vec3d to);

    // z of the lower side; kInfinite beside the sweep.
    double height(Vec2d p) const;

    // A plane that the lower side is nowhere below, and that touches it near p.
    SupportPlane plane_below(Vec2d p) const;

    // mm: from the tool's axis to p, in plan.
    double distance(Vec2d p) const;

    // True if the other sweep is provably inside this one. False where the proof fails, too.
    bool contains(const ToolSweep& other) const;

    double radius() const { return end_.radius; }
    double lowest() const { return from_.z < to_.z ? from_.z : to_.z; }
    Vec2d low() const;  // corner of the box in plan
    Vec2d high() const;
    Vec3d from() const { return from_; }
    Vec3d to() const { return to_; }

private:
    EndProfile end_;
    Vec3d from_;
    Vec3d to_;
    Vec2d way_{1.0, 0.0};
    double length_{};  // in plan
    double slope_{};

    // Distance along the move at which the tool is lowest over a point, mm; negative: nowhere.
    double lowest_place(Vec2d p) const;
    double numeric_place(double along, double away, double low, double high) const;
    Vec2d axis(double place) const { return in_plan(from_) + way_ * place; }
    bool holds_end(const ToolSweep& other, Vec3d tip) const;
};

}  // namespace cusp::rest_machining
