// Margin for rounding; the planner uses the axes' limits less this.
#pragma once

#include "firmware/base/machine_limits.hpp"

namespace cusp::planner {

// The limits for the motion before rounding.
MachineLimits with_margin(const MachineLimits& limits) noexcept;

}  // namespace cusp::planner
