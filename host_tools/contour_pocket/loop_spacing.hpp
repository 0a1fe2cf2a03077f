// How far inward from a level of loops the next one may lie.
#pragma once

#include "host_tools/contour_pocket/pocket_task.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

// The highest ridge, square to the floor, that passes at the first and the last of evenly spaced
// places leave over what passes at all of them would leave.
//
//   heights  of the tip at the places, mm; at least two
//   apart    mm from the first place to the last
double scallop_between(const toolpath::Tool& tool,
                       const std::vector<double>& heights,
                       double apart);

// No interval is less, mm: on the steepest floor that a flat end mill cuts in steps of half the
// cusp's width they are half as high. A hundredth of the tool's radius bounds the work.
double least_stepover(const toolpath::Tool& tool, const ToleranceSplit& tolerances);

class LoopSpacing {
public:
    // corners: the uncut material between loops is cut at an angle there, so every direction
    // counts. scallops: where the floor between two passes is not what its curvature at one of them
    // says (a valley tighter than the tool, an edge), the ridge itself is looked at; else that is
    // left to LoopScallop.
    LoopSpacing(const drop_cutter::DropCutter& floor,
                const ToleranceSplit& tolerances,
                bool corners,
                bool scallops)
        : floor_{floor}, tolerances_{tolerances}, corners_{corners}, scallops_{scallops}
    {
    }

    // The least distance inward from the level, mm, at which no cusp between is higher than
    // allowed, by plan_stepover() and the ridge.
    //
    //   proven  mm: a distance at which nothing too high stands, see LoopScallop. The answer as
    //           soon as some place of the level allows hardly more: others could only allow less.
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
    double by_scallop(Vec2d at, Vec2d direction, double most) const;
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
