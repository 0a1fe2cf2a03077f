// Bounds the distance of heights along a line from the chord between two of them: bounds from five
// heights and a bound of curvature or of slope (surface_bounds.hpp).
#pragma once

#include <array>

namespace cusp::drop_cutter {

// Heights of a tool's tip along a straight line in plan, at -1/2, 0, 1/2, 1 and 3/2 of a move.
struct LineHeights {
    std::array<double, 5> z;  // mm; the first and the last do not count for off_by_slope()
    double step;              // mm between them
    double error;             // mm: true heights are at most this much lower, and not higher

    // z of the move, at x mm from its start.
    double chord(double x) const { return z[1] + (z[3] - z[1]) * x / (2 * step); }
};

// mm: upper bound of the distance between the move and heights that z + curvature / 2 * x^2 makes convex along the
// line. Convex functions lie below the chords between places, and above the lines through the two places beyond.
double off_by_curvature(const LineHeights& h, double curvature);

// mm: likewise of heights that rise and fall by at most this slope.
double off_by_slope(const LineHeights& h, double slope);

}  // namespace cusp::drop_cutter
