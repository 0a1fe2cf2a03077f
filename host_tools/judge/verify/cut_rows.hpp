// Cuts a tool into the heights of one column of a grid.
#pragma once

#include <algorithm>
#include <cstddef>

#include "host_tools/judge/verify/end_sweeps.hpp"

namespace cusp::verify {

// Rows of a column that a disc reaches.
struct DiscColumn {
    std::size_t index;
    std::size_t first;
    std::size_t last;
    double x;  // mm, of the column from the disc's centre
    double y;
    const double* row_x;
    const double* row_y;

    // mm^2, from the centre
    double squared(std::size_t j) const
    {
        const double dx = x + row_x[j];
        const double dy = y + row_y[j];
        return dx * dx + dy * dy;
    }
};

// A tool with its tip at `z`, and what measures its depth: the tool reduced by `shrink`, raised by as much.
struct Cutter {
    double z;
    double shrink;
    Profile profile;
    Profile probe;
};

// Rows that are compared together: most are below the tool.
inline constexpr std::size_t kRun = 16;

// The highest of the rows [first, last).
inline double highest_of(const double* heights, std::size_t first, std::size_t last)
{
    double highest = -kUnbounded;
#pragma omp simd reduction(max : highest)
    for (std::size_t j = first; j < last; ++j) {
        highest = std::max(highest, heights[j]);
    }
    return highest;
}

// These return how deep the measuring tool is in the stock, or `deepest` where that is more.
inline double cut_rows_flat(const Cutter& cutter,
                            DiscColumn column,
                            double* heights,
                            double deepest)
{
    const double z = cutter.z;
    const double reach = cutter.profile.reach;
    for (std::size_t j0 = column.first; j0 < column.last; j0 += kRun) {
        const std::size_t j1 = std::min(column.last, j0 + kRun);
        if (highest_of(heights, j0, j1) <= z) {
            continue;
        }
        for (std::size_t j = j0; j < j1; ++j) {
            const double squared = heights[j] > z ? column.squared(j) : kUnbounded;
            if (squared <= reach) {
                deepest = squared <= cutter.probe.reach
                              ? std::max(deepest, heights[j] - z - cutter.shrink)
                              : deepest;
                heights[j] = z;
            }
        }
    }
    return deepest;
}

inline double cut_rows(const Cutter& cutter, DiscColumn column, double* heights, double deepest)
{
    const Cutter own = cutter;  // which the heights do not alias
    const double steepness = own.profile.steepness();
    for (std::size_t j0 = column.first; j0 < column.last; j0 += kRun) {
        const std::size_t j1 = std::min(column.last, j0 + kRun);
        double over = 0;
#pragma omp simd reduction(max : over)
        for (std::size_t j = j0; j < j1; ++j) {
            const double squared = column.squared(j);
            over = std::max(over, std::min(own.profile.reach - squared,
                                           heights[j] - own.z - steepness * squared));
        }
        if (over <= 0) {
            continue;
        }
#pragma omp simd reduction(max : deepest)
        for (std::size_t j = j0; j < j1; ++j) {
            const double squared = column.squared(j);
            const double tracked = heights[j] - own.z - own.shrink - own.probe.at(squared);
            deepest = std::max(deepest, squared <= own.probe.reach ? tracked : 0.0);
            const double lower = own.z + own.profile.at(squared);
            heights[j] = squared <= own.profile.reach ? std::min(lower, heights[j]) : heights[j];
        }
    }
    return deepest;
}

}  // namespace cusp::verify
