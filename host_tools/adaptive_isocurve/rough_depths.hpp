// How deep roughing levels are cut, and how high ridges between passes may stand for that.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"

namespace cusp::adaptive_isocurve {

struct RoughDepths {
    std::vector<double> heights;  // z of the tip, level by level, falling
    double scallop_height{};      // mm: what passes of one cutter may leave between them
    double rest_height{};  // mm over its own underside that a cutter after another one leaves uncut
    double thinnest{};     // mm: the level of least depth
};

struct PassSpacing {
    double stepover;        // mm between passes
    double scallop_height;  // mm left between them, at most what was asked for
};

// A flat part clears all it covers; round corners leave ridges.
PassSpacing pass_spacing(const toolpath::Tool& tool, double scallop_height);

// Levels from `top` down to `bottom` (z): as few as max_depth allows, each as deep as the others,
// or where the job's `layers` lie. No cut is deeper than max_depth (default: the least radius), the
// ridges of the level above included. Where levels would be thinner than min_depth, ridges are made
// lower and levels fewer, as far as max_depth lets them.
//
// tools  all that rough; not empty
//
// Errors: InputError where max_depth is no depth or makes too many levels, or `layers` go below the
// bottom, deeper than max_depth or less deep than min_depth; where nothing is to be roughed.
RoughDepths rough_depths(const job::Job& job,
                         const job::Operation& operation,
                         const std::vector<toolpath::Tool>& tools,
                         double top,
                         double bottom);

}  // namespace cusp::adaptive_isocurve
