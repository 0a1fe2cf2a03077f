// Conditions that a curve or surface must meet before it is used.
#pragma once

#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Coordinates beyond this, in mm, are refused: no machine is that large, and doubles keep
// nanometres up to there.
inline constexpr double kLargestCoordinate = 1e6;

// Largest weight over the smallest. A larger ratio makes a corner, for which there are knots.
inline constexpr double kLargestWeightRatio = 1000;

// Greatest length of a domain; its reciprocal is the least.
inline constexpr double kLargestDomain = 1e9;

// Makes knots equal that differ by rounding only (1e-15 of the domain).
void merge_close_knots(std::vector<double>& knots);

// Both throw InputError that starts with `place` (file and which curve or surface) and names the
// quantity, its value and its limit.
void check_curve(const nurbs::Curve& curve, const std::string& place);
void check_surface(const nurbs::Surface& surface, const std::string& place);

}  // namespace cusp::import
