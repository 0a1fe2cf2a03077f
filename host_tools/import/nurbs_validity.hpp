// What a curve or surface must fulfil before anything here computes with it.
#pragma once

#include <string>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::host {

// Coordinates beyond this, in mm, are refused: no machine is that large, and doubles keep
// nanometres up to there.
inline constexpr double kLargestCoordinate = 1e6;

// Both throw InputError that starts with `place` (file and which curve or surface) and names the
// quantity, its value and its limit.
void check_curve(const Curve& curve, const std::string& place);
void check_surface(const Surface& surface, const std::string& place);

}  // namespace cusp::host
