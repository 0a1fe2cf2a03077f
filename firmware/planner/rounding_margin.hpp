// Margin for rounding; the planner uses the axes' limits less this.
#pragma once

#include <cstdint>

#include "firmware/base/machine_limits.hpp"
#include "firmware/planner/block.hpp"

namespace cusp::planner {

// The limits for the motion before rounding. `path_filter` is its length in ticks.
MachineLimits with_margin(const MachineLimits& limits, std::uint32_t path_filter) noexcept;

// Takes from acceleration and jerk what rounded places on a curve need behind these filters.
// Source: docs/numerics.md, "The envelope".
void leave_to_rounding(MachineLimits& limits, AxisFilter filter) noexcept;

}  // namespace cusp::planner
