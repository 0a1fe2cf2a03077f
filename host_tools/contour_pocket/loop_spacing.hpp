// How far inward from a ring of loops the next one may lie.
#pragma once

#include "host_tools/contour_pocket/pocket_task.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

// The highest scallop, square to the floor, that passes at the first and the last of evenly spaced
// places leave over the profile that passes at all of them would cut.
//
//   heights  of the tip at the places, mm; at least two
//   apart    mm from the first place to the last
double scallop_between(const toolpath::Tool& tool,
                       const std::vector<double>& heights,
                       double apart);

// No stepover is less, mm: half the scallop's height, which on the steepest floors bounds the steps
// that a flat end mill leaves, or a hundredth of the tool's radius, which bounds the work.
double least_stepover(const toolpath::Tool& tool, const ToleranceSplit& tolerances);

class LoopSpacing {
public:
    // corners   sections in every direction at corners, where loops meet at an angle
    // scallops  where the floor between two passes differs from what its curvature at one of them
    //           predicts (a valley tighter than the tool, an edge), the scallop itself is computed;
    //           else that is left to LoopScallop
    LoopSpacing(const drop_cutter::DropCutter& floor,
                const ToleranceSplit& tolerances,
                bool corners,
                bool scallops)
        : floor_{floor}, tolerances_{tolerances}, corners_{corners}, scallops_{scallops}
    {
    }

    // The least distance inward from the ring, mm, at which no scallop between is higher than
    // allowed, by plan_stepover() and the scallop itself.
    //
    //   proven  mm: a distance at which no scallop is too high, see LoopScallop. It is returned as
    //           soon as some place of the ring allows hardly more: others could only allow less.
    double stepover_from(const offset::Region2d& level, double proven = 0.0);

    // How far inward the next level may lie, mm, so that the path is shortest if parts of the level
    // that need less get partial loops in halves, quarters ... of that; 0 where that is not worth
    // it over whole loops `step` apart. By the formula alone.
    double with_partial_loops(const offset::Region2d& level, double step) const;

private:
    struct Sample {
        double share;  // of the edge
        Vec2d direction;
        drop_cutter::DropCutter::CcPoint contact;
    };
    Sample sample(const offset::Edge& edge, double share);
    void refine(const offset::Edge& edge, double whole, const Sample& a, const Sample& b);
    drop_cutter::DropCutter::CcPoint contact(Vec2d at) const;
    double allowed(const drop_cutter::DropCutter::CcPoint& contact, Vec2d direction) const;
    void across(Vec2d at, const drop_cutter::DropCutter::CcPoint& here, Vec2d direction);
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
