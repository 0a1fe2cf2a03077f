// Spacing of the rings of loops: how far inward from a ring the next one may lie.
#pragma once

#include <optional>

#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

// The highest scallop, along the normal, that passes at the first and the last of evenly spaced
// places leave above the profile that passes at all of them would cut.
//
// heights  mm, of the tip at the places; at least two
// apart    mm from the first place to the last
double scallop_between(const toolpath::Tool& tool,
                       const std::vector<double>& heights,
                       double apart);

// mm: lower limit of the stepover. Half the scallop's height bounds the steps of a flat end mill on
// the steepest floors; a hundredth of the tool's radius bounds the computation.
double least_stepover(const toolpath::Tool& tool, const ToleranceSplit& tolerances);

class LoopSpacing {
public:
    // corners   also sections in all directions at corners, where loops meet at an angle
    // scallops  where the floor between two passes differs from the prediction by its curvature (a
    //           valley tighter than the tool, a crease), the scallop itself is computed; else
    //           LoopScallop does that
    LoopSpacing(const drop_cutter::DropCutter& floor,
                const ToleranceSplit& tolerances,
                bool corners,
                bool scallops)
        : floor_{floor}, tolerances_{tolerances}, corners_{corners}, scallops_{scallops}
    {
    }

    // mm: the least distance inward from the ring at which no scallop is higher than allowed, by
    // plan_stepover() and the scallop itself.
    //
    // proven  mm: a distance at which no scallop is too high, see LoopScallop. It is returned as
    //         soon as a place of the ring allows hardly more, since others could only allow less.
    double stepover_from(const offset::Region2d& ring, double proven = 0.0);

    // mm: how far inward the next ring may lie for the shortest path if parts that need less get
    // partial loops at halves, quarters ... of that; 0 if whole loops `step` apart are as good. By
    // the stepover formula alone.
    double with_partial_loops(const offset::Region2d& ring, double step) const;

private:
    using Contact = std::optional<drop_cutter::DropCutter::CcPoint>;
    struct Sample {
        double share;  // of the edge
        Vec2d direction;
        Contact contact;
    };
    Sample sample(const offset::Edge& edge, double share);
    void refine(const offset::Edge& edge, double whole, const Sample& a, const Sample& b);
    Contact contact(Vec2d at) const;
    double allowed(const Contact& contact, Vec2d direction) const;
    void across(Vec2d at, const Contact& here, Vec2d direction);
    bool as_expected(const drop_cutter::DropCutter::CcPoint& a,
                     const drop_cutter::DropCutter::CcPoint& b,
                     Vec2d direction,
                     double apart) const;
    double by_scallop(Vec2d at, Vec2d direction, double widest) const;
    double within_limits(double interval) const;
    double found() const;
    void along(const offset::Edge& edge);
    void around(Vec2d at);

    const drop_cutter::DropCutter& floor_;
    const ToleranceSplit& tolerances_;
    bool corners_;
    bool scallops_;
    double least_{};
    double since_{};  // mm along the loop from the last sample
};

}  // namespace cusp::contour_pocket
