// Lengths, counts and times of tool paths.
#pragma once

#include <array>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

struct MoveCounts {
    int lines{};
    int arcs{};
    int nurbs{};
    int rapids{};
};

struct PathMeasure {
    MoveCounts moves;
    double cut_length_mm{};   // all feed moves: cuts, links and plunges
    double link_length_mm{};  // the links of them
    double rapid_length_mm{};
    double estimated_s{};
    Vec3d end;
};

// The machine of the time estimate; the default is the controller's default machine.
struct MachineRates {
    Vec3d velocity{100, 100, 50};         // mm/s
    Vec3d acceleration{1000, 1000, 500};  // mm/s^2
    Vec3d jerk{50000, 50000, 25000};      // mm/s^3
    bool exact_stop{true};                // G61: every corner over 0.5 degrees is a stop
};

// start  where the tool is before the path's first move
//
// estimated_s is the time of trapezoidal profiles with look-ahead. From stop to stop the time that
// jerk adds to a straight move of the same length is included. It is up to 15 % low; the simulator
// gives the time to the tick.
PathMeasure measure(const Toolpath& path, Vec3d start, const MachineRates& rates = {});

// Length of the parts of all feed moves at which the tip is above z, mm; curves by chords within
// 0.01 mm.
//
// start  where the tool is before the path's first move
double cut_length_above(const Toolpath& path, Vec3d start, double z);

// Points of a move from `start`, chords within `tolerance` mm of it, the end included and the start
// not.
std::vector<Vec3d> points_of(const ToolMove& move, Vec3d start, double tolerance);

Vec3d end_of(const ToolMove& move);

// The steepest descent of the move from `start`, as dz over the path length: 0 to 1. Curves are
// measured along chords.
double steepest_descent(const ToolMove& move, Vec3d start);

// mm/min that the move is programmed with; 0 for rapids.
double feed_of(const Toolpath& path, const ToolMove& move, Vec3d start);

}  // namespace cusp::toolpath
