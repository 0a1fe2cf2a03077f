// Depths of roughing levels, and the scallops between passes that they allow.
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

struct RoughDepths {
    std::vector<double> heights;  // z of the tip, level by level, falling; empty: nothing to rough
    double scallop_height{};      // mm: between passes of one cutter
    double rest_height{};         // mm: stock that a later cutter may leave above its own underside
    double thinnest{};            // mm: the least depth of a level
};

struct PassSpacing {
    double stepover;        // mm between passes
    double scallop_height;  // mm left between them, at most the value given
};

// The stepover of a roughing cutter: by its flat, which leaves no scallops, or by its corners.
PassSpacing pass_spacing(const toolpath::Tool& tool, double scallop_height);

// Levels from `top` down to `bottom` (z): as few of equal depth as max_depth allows, or the job's
// `layers`. No cut is deeper than max_depth (default: the least radius), the scallops of the level
// above included. If levels would be thinner than min_depth, scallops become lower and levels
// fewer, as far as max_depth allows.
//
// tools  all roughing tools; not empty
//
// No heights where `top` is not above `bottom`, unless the job gives layers.
//
// Errors: InputError where max_depth is not above 0.002 mm or makes too many levels; where `layers`
// lie below the bottom or violate max_depth or min_depth.
RoughDepths rough_depths(const job::Job& job,
                         const job::Operation& operation,
                         const std::vector<toolpath::Tool>& tools,
                         double top,
                         double bottom);

}  // namespace cusp::adaptive_isocurve
