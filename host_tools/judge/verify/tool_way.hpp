// A tool on a straight way: the lowest that its end passes over a place, on any slope.
//
//     const ToolWay way{tool, tool.radius, from, to};
//     way.lowest(place, 0);      // z, kUnbounded where the tool does not pass
//     way.lowest(place, 0.1);    // no place within 0.1 mm is passed lower
//     way.lowest(place, -0.1);   // all places within 0.1 mm are passed as low
#pragma once

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::verify {

class ToolWay {
public:
    // tool    lives longer
    // radius  mm, up to the tool's: what is beyond it passes nothing
    ToolWay(const toolpath::Tool& tool, double radius, Vec3d from, Vec3d to);

    // z over a place, of the tool with all radii larger by `wider`; kUnbounded where it does not pass.
    double lowest(Vec2d place, double wider) const;

    // True if lowest(place, wider) is below `level`, at most.
    bool is_below(Vec2d place, double wider, double level) const;

    // The tip where the tool passes a place lowest. Precondition: it passes there.
    Vec3d tip_over(Vec2d place) const;

    double radius() const { return radius_; }
    double least_z() const { return from_.z < to_.z ? from_.z : to_.z; }
    Vec2d low() const;  // of the box in plan
    Vec2d high() const;

    // mm in plan, from the way.
    double away(Vec2d place) const;

private:
    // The shares of the way from `begin` to `end` on which the tool passes a place; none: begin > end.
    struct Stretch {
        double begin;
        double end;
    };
    double nearest(Vec2d place) const;
    Stretch stretch(Vec2d place, double reach) const;
    double share_of_lowest(Vec2d place, double wider, Stretch passed) const;
    double height(Vec2d place, double wider, double share) const;

    const toolpath::Tool* tool_;
    double radius_;
    Vec3d from_;
    Vec3d to_;
    double squared_;  // mm^2: of its length in plan
    bool is_cylinder_;
};

}  // namespace cusp::verify
