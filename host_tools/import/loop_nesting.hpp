// Groups the curves of a drawing into closed loops, nested in each other, and open chains.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// mm: largest distance of ends that meet.
inline constexpr double kEndsMeet = 1e-3;
// mm: default of the largest gap that is joined; a job's plan_tolerance replaces it.
inline constexpr double kJoinTolerance = 0.02;

// In plan, mm.
struct ClosedLoop {
    std::vector<nurbs::Curve> curves;  // in order
    std::vector<Vec2d> outline;        // chords within 1e-3 mm; the last point is the first again
    double length{};
    double area{};                  // above 0, or 0
    bool counter_clockwise{};       // as drawn
    int parent{-1};                 // index of the smallest loop around it; -1: none
    int depth{};                    // loops around it: even encloses material, odd is a hole
    std::optional<Vec2d> crossing;  // where it crosses itself
};

struct OpenChain {
    std::vector<Vec2d> outline;
    std::size_t curves{};
    double length{};
    Vec2d begin, end;
    // From one of its ends to the nearest end of any chain, this one's other end included.
    double gap{};
    Vec2d gap_from, gap_to;
};

struct LoopNesting {
    std::size_t curves{};
    std::size_t repeated{};         // drawn a second time over another one; left out
    std::vector<ClosedLoop> loops;  // the largest first
    std::vector<OpenChain> open;
    std::size_t bridged{};          // gaps over 1e-3 mm that were joined
    double widest_gap{};            // mm, of those
    std::optional<Vec2d> crossing;  // where two loops cross: their nesting is undefined
};

// Ends within 1e-3 mm meet. Remaining open chains are joined where their ends are at most `join` mm
// apart, the nearest first. Lengths and areas are integrals over the curves, with a relative error
// of 1e-9 for arcs of up to a quarter turn for each span.
//
// Where more than two ends meet, it is unspecified along which one a chain continues.
LoopNesting nest_loops(const std::vector<nurbs::Curve>& curves, double join = kJoinTolerance);

}  // namespace cusp::import
