// How far inward from a level of loops the next one may lie.
#pragma once

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/contour_pocket/pocket_task.hpp"

namespace cusp::host {

// The highest ridge, square to the floor, that passes at the first and the last of evenly spaced
// places leave over what passes at all of them would leave.
//
//   heights  of the tip at the places, mm; at least two
//   apart    mm from the first place to the last
double ridge_between(const Tool& tool, const std::vector<double>& heights, double apart);

// No interval is less, mm: on the steepest floor that a flat end mill cuts in steps of half the
// cusp's width they are half as high. A hundredth of the tool's radius bounds the work.
double least_interval(const Tool& tool, const Budget& budget);

class LevelInterval {
public:
    // corners: metal between loops is reached from askew there, so that every direction counts.
    // ridges: where the floor between two passes is not what its curvature at one of them says (a
    // valley tighter than the tool, an edge), the ridge itself is looked at; else that is left to
    // StripRidge.
    LevelInterval(const TipFloor& floor, const Budget& budget, bool corners, bool ridges)
        : floor_{floor}, budget_{budget}, corners_{corners}, ridges_{ridges}
    {
    }

    // The least distance inward from the level, mm, at which no cusp between is higher than
    // allowed, by path_interval() and the ridge.
    //
    //   proven  mm: a distance at which nothing too high stands, see StripRidge. The answer as
    //           soon as some place of the level allows hardly more: others could only allow less.
    double from(const Region2d& level, double proven = 0.0);

    // How far inward the next level may lie, mm, so that the path is shortest if parts of the level
    // that need less get partial loops in halves, quarters ... of that; 0 where that is not worth
    // it over whole loops `step` apart. By the formula alone.
    double with_partial_loops(const Region2d& level, double step) const;

private:
    struct Sample {
        double share;  // of the edge
        Vec2d way;
        TipFloor::Contact contact;
    };
    Sample sample(const Edge& edge, double share);
    void refine(const Edge& edge, double whole, const Sample& a, const Sample& b);
    TipFloor::Contact contact(Vec2d at) const;
    double allowed(const TipFloor::Contact& contact, Vec2d direction) const;
    void across(Vec2d at, const TipFloor::Contact& here, Vec2d direction);
    bool as_expected(const TipFloor::Contact& a,
                     const TipFloor::Contact& b,
                     Vec2d direction,
                     double apart) const;
    double by_ridge(Vec2d at, Vec2d direction, double most) const;
    double kept(double interval) const;
    double found() const;
    void along(const Edge& edge);
    void around(Vec2d at);

    const TipFloor& floor_;
    const Budget& budget_;
    bool corners_;
    bool ridges_;
    double least_{};
    double since_{};  // mm along the loop from the last sample
};

}  // namespace cusp::host
