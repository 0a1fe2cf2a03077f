// The clearance of roughing from the model, measured move by move.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_isocurve/rough_constants.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_rougher.hpp"

namespace cusp::adaptive_isocurve {

inline constexpr double kClearanceResolution = 1e-3;  // mm: how much too low a clearance may be

// mm: the least clearance of the first `count` moves, of those below the model's top and the allowance.
double least_clearance(const RoughWork& work,
                       const toolpath::Tool& tool,
                       const std::vector<toolpath::ToolMove>& moves,
                       std::size_t count);

}  // namespace cusp::adaptive_isocurve
